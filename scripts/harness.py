"""What all measurements of scripts/measure.py share: programs, their commands, runs and what is said of them."""

import datetime
import json
import resource
import shlex
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
ERRORS = ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m")
COMPLETE = "complete"  # empty file in the folder of a finished run
MANY_LOST = 5  # exit code of a run that lost many frames, which is a result as well
# Steps of rendered scenes are a few cm: a limit of 5 cm would hide any error.
STEP_OF_RENDERED = ("--step-metres", 0.005, "--step-degrees", 0.25)


def commit():
    """Of the sources, followed by "+" if they have uncommitted changes outside the documentation."""

    def git(*arguments):
        command = ["git", "-C", REPOSITORY, *arguments]
        return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()

    changed = git("status", "--porcelain", "--", ".", ":!doc", ":!README.md")
    return git("rev-parse", "--short=7", "HEAD") + ("+" if changed else "")


def write(result, measured, file):
    """Writes `result` as JSON, with the commit `measured` and the date in front."""
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    file.write_text(json.dumps({"commit": measured, "date": today, **result}, indent=1) + "\n", encoding="utf-8")


class Problem(Exception):
    """An error to report to the user."""


class Programs:
    """Runs the programs and records the commands as a reader would type them."""

    def __init__(self, options):
        self.options = options
        self.made = set()  # files and folders of this call: two rows may use the same run

    def call(self, command, allowed=(0,), **options):
        """What a program prints, and its processor time [s], that of decoding and starting included."""
        command, before = [str(part) for part in command], resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                                  **options)
        except OSError as error:
            raise Problem(f"{command[0]} cannot be started: {error.strerror}") from error
        if done.returncode not in allowed:
            raise Problem(f"{shlex.join(command)}\nended with code {done.returncode}: {done.stderr.strip()[-300:]}")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def result(self, what, file, command):
        """The JSON that a command writes to the path `file`; --keep reuses it. `what` is printed before it runs."""
        if not (self.options.keep and file.exists()):
            print(what, file=sys.stderr, flush=True)
            self.call([*command, "--quiet", "--force", "--json", file])
        return json.loads(file.read_text(encoding="utf-8"))

    def run(self, folder, command):
        """Runs a command that writes a folder of results, once; --keep reuses a complete one. Returns its processor
        time [s], None of one that is reused."""
        if folder in self.made or self.options.keep and (folder / COMPLETE).exists():
            return None
        print(folder.relative_to(self.options.work), file=sys.stderr, flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        folder.parent.mkdir(parents=True, exist_ok=True)
        _, used = self.call([*command, "-o", folder], (0, MANY_LOST))
        (folder / COMPLETE).touch()
        self.made.add(folder)
        return used

    def track(self, folder, source, method=(), seed=1):
        """`quadedge run` or `demo` with these arguments. Returns its command and its processor time [s]."""
        command = [self.options.quadedge, *source, *method, "--seed", seed, "--quiet"]
        used = self.run(folder, command)
        return self.text([*command, "-o", folder]), used

    def text(self, command):
        """The command with DATA, OUT and plain program names instead of the paths of this machine."""
        names = {str(self.options.quadedge): "quadedge", str(self.options.baseline): "opencv_baseline",
                 sys.executable: "python"}
        parts = [names.get(str(part), str(part)) for part in command]
        short = {str(self.options.work): "OUT", str(self.options.data): "DATA", str(REPOSITORY): "."}
        for index, part in enumerate(parts):
            for folder, name in short.items():
                if part == folder or part.startswith(folder + "/"):
                    parts[index] = part = name + part[len(folder) :]
        return shlex.join(part for part in parts if part not in ("--quiet", "--force"))

    def evaluate(self, folder, truth, *options):
        """What `quadedge evaluate trajectory` says of the run in a folder; nothing of fewer than three poses. Returns
        the command as well."""
        command = [self.options.quadedge, "evaluate", "trajectory", folder / "trajectory.txt", truth, *options]
        said = {}
        if len(positions(folder)) >= 3:
            file = folder / "evaluation.json"
            self.call([*command, "--json", file, "--force"])
            said = json.loads(file.read_text(encoding="utf-8"))
        return said, self.text(command)


def report(folder):
    """report.json of a run."""
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))


def positions(folder):
    """Stamp and position of every pose of trajectory.txt [s, m]."""
    return [[float(value) for value in line.split()[:4]]
            for line in (folder / "trajectory.txt").read_text(encoding="utf-8").splitlines()
            if line and not line.startswith("#")]


def means(accuracy):
    """The errors of Table 4: origin-aligned means."""
    return {name: accuracy["origin_aligned"][name]["mean"] for name in ERRORS}


def combined(values, how):
    """`how` (a median, min or max) of figures, which may be in dictionaries and lists; texts are those of the first."""
    first = values[0]
    if isinstance(first, dict):
        return {name: combined([value[name] for value in values], how) for name in first}
    if isinstance(first, list):
        return [combined(list(each), how) for each in zip(*values)]
    return first if first is None or isinstance(first, str) else how(values)


def over_seeds(rows):
    """One row for the runs with several seeds: medians, and the least and the greatest figures as rows of their own."""
    if any(row.keys() != rows[0].keys() for row in rows):
        raise Problem(f"{rows[0]['title']}: with some seeds, too few poses to compare")
    least, most = ({name: value for name, value in combined(rows, how).items() if name != "commands"}
                   for how in (min, max))
    return {**combined(rows, statistics.median_low), "seeds": len(rows), "least": least, "most": most}
