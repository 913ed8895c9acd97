"""The origin of a page's figures: program, input, device and configuration."""

from .numbers import DASH


def changed_constants(content: dict) -> str:
    """The configuration values that differ from the defaults, such as "stereo.ncc_min = 0.7"."""
    if "config_changed" not in content:
        return DASH
    changed = [f"{key} = {value}" for key, value in content["config_changed"].items()]
    return ", ".join(changed) or "defaults"


def device_text(device: dict) -> str:
    return f"{device['name']} ({device['platform']}, {device['opencl']}, driver {device['driver']})"


def origin(content: dict, device: str, recording: str) -> list[tuple[str, str]]:
    """Input, program, date, device, configuration and command of a JSON result, as terms and texts."""
    commit = content.get("commit")
    return [("Input", recording),
            ("Program", f"QuadEdge {content.get('version', DASH)}" + (f", commit {commit}" if commit else "")),
            ("Date", content.get("date", DASH).replace("T", " ").replace("Z", " UTC")),
            ("Device", device or DASH),
            ("Configuration", changed_constants(content)),
            ("Command", content.get("command") or DASH)]
