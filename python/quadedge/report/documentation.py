"""Where the documentation lies that explains the parts of a page."""

import functools
import sys
from importlib import metadata
from pathlib import Path
from urllib.parse import quote

_LABEL = "Documentation"  # of the address in the package's metadata


@functools.cache
def _address() -> str:
    """Of the documentation: the published one if the package names it, else a folder of this machine, else ""."""
    try:
        urls = metadata.metadata("quadedge").get_all("Project-URL") or []
    except metadata.PackageNotFoundError:
        urls = []
    for url in urls:
        label, _, address = url.partition(",")
        if label.strip() == _LABEL:
            return address.strip().rstrip("/") + "/"
    checkout, installed = Path(__file__).resolve().parents[3], Path(sys.prefix) / "share/doc/quadedge"
    for folder in (checkout / "doc", installed / "doc"):
        if (folder / "reference.md").is_file():
            return "file://" + quote(str(folder)) + "/"
    return ""


def explanation_of(page: str) -> tuple[str, str]:
    """Address of a page such as "accuracy.md#presets", "" if there is none, and how to call it."""
    address = _address()
    return address and address + page, "doc/" + page.partition("#")[0]
