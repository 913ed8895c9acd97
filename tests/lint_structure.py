#!/usr/bin/env python3
"""Checks that the tree follows doc/design.md: includes between folders, lengths, names and references.

    lint_structure.py REPOSITORY [--program PROGRAM] [CHECK...]

CHECK is any of: includes lines sizes phrases functions twins references constants; without one, all of them.
`functions` needs lizard (tests/requirements.txt), `constants` the program. Prints one line per finding and what the
house holds; exit code 1 if there is any finding.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

LONGEST_LINE = 120
LONGEST_FUNCTION = 60
CODE = {".cpp", ".hpp", ".cl", ".py", ".sh", ".cmake", ".toml", ".txt"}
SOURCES = (".cpp", ".hpp", ".cl", ".inc", ".py", ".sh")
SIZED = {"host", "include", "kernels", "python", "bench", "ros2", "scripts", "tests"}
# Most lines of source per folder. Whoever raises a limit says why in the commit.
MOST_LINES = {
    "bench": 283,
    "host/tracker/common": 1052,
    "host/tracker/device": 4571,
    "host/tracker/edges": 2892,
    "host/tracker/geometry": 2199,
    "host/tracker/motion": 6612,
    "host/tracker/places": 2263,
    "host/tracker/rig": 2136,
    "host/workbench/benchmark": 1078,
    "host/workbench/calibration": 1770,
    "host/workbench/cli": 4152,
    "host/workbench/data": 5858,
    "host/workbench/data/calibrations": 2084,
    "host/workbench/oracle": 435,
    "host/workbench/output": 2365,
    "host/workbench/paper": 898,
    "host/workbench/reference": 2352,
    "host/workbench/scenes": 2775,
    "include": 2233,
    "kernels": 6276,
    "python": 9318,
    "ros2": 90,
    "scripts": 2088,
    "tests": 29995,
}
TRACKER, WORKBENCH = "host/tracker/", "host/workbench/"
# Lines of systems that do the same, counted alike.
MODELS = {"tracker": "Basalt 31,000, OpenVINS 28,000", "Python": "rko_lio 3,200", "words of pages": "15,000"}
STALE_PHRASES = re.compile(
    r"without a word|said to be|so many |are no (times|stamps)|where to go on|knows no more|stands (in|once)|dge\[")
LAYERS = ("include/quadedge", "host", "bench", "tests", "examples", "python")


class Tree:
    """The files of a repository that git tracks, and their texts."""

    def __init__(self, root: Path):
        self.root = root
        call = ["git", "-C", root, "ls-files"]
        names = subprocess.run(call, check=True, capture_output=True, text=True).stdout.split("\n")
        self.files = sorted(name for name in names if name and (root / name).is_file())
        self.base_names = {Path(name).name for name in self.files}
        self.folders = {str(parent) for name in self.files for parent in Path(name).parents}

    def text(self, name: str) -> str:
        return (self.root / name).read_text(encoding="utf-8")

    def with_suffix(self, *suffixes: str) -> list[str]:
        return [name for name in self.files if Path(name).suffix in suffixes]

    def table(self, name: str) -> list[list[str]]:
        """The rows of the table between <!-- NAME --> and <!-- end of NAME --> in doc/design.md."""
        found = re.search(rf"<!-- {name} -->\n(.*?)<!-- end of {name} -->", self.text("doc/design.md"), re.DOTALL)
        if not found:
            return []
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in found[1].strip().split("\n")]
        return rows[2:]


def folder_of(name: str) -> str:
    parts = Path(name).parts
    return parts[2] if parts[0] == "host" else parts[0]


def check_includes(tree: Tree) -> list[str]:
    """Includes follow the table, in which every public header belongs to a folder; the tracker includes none of the
    workbench's."""
    rows = tree.table("includes")
    public = {f"quadedge/{header}.hpp": row[0] for row in rows for header in row[1].split(", ")}
    allowed = {row[0]: {row[0], *row[2].split(", ")} for row in rows}
    findings = []
    for name in tree.with_suffix(".cpp", ".hpp"):
        folder = public.get(name.removeprefix("include/"), folder_of(name))
        if name.startswith(LAYERS) and folder not in allowed:
            findings.append(f"{name}: doc/design.md does not say what it may include, or the folder that it belongs to")
        for number, line in enumerate(tree.text(name).split("\n"), 1):
            included = re.match(r'#include "(([a-z_]+)/.*hpp)', line)
            if not included or {"any", included[2]} & allowed.get(folder, {"any"}):
                continue
            target = public.get(included[1], included[2])
            if target not in allowed[folder] or TRACKER + folder in tree.folders and WORKBENCH + target in tree.folders:
                findings.append(f"{name}:{number}: {folder} includes {target}, which doc/design.md does not allow")
    return findings


def check_lines(tree: Tree) -> list[str]:
    """No line of code beyond LONGEST_LINE columns, no tab, no trailing space."""
    findings = []
    for name in tree.files:
        if Path(name).suffix not in CODE and Path(name).name != "Snakefile":
            continue
        for number, line in enumerate(tree.text(name).split("\n"), 1):
            if len(line) > LONGEST_LINE:
                findings.append(f"{name}:{number}: {len(line)} columns, at most {LONGEST_LINE}")
            if line != line.rstrip() or "\t" in line:
                findings.append(f"{name}:{number}: a tab or a trailing space")
    return findings


def check_sizes(tree: Tree) -> list[str]:
    """No folder has more lines of source than MOST_LINES allows; no source is outside of it."""
    counted = dict.fromkeys(MOST_LINES, 0)
    findings = []
    for name in tree.with_suffix(*SOURCES):
        parents = {str(parent) for parent in Path(name).parents}
        if parents & MOST_LINES.keys():
            counted[max(parents & MOST_LINES.keys(), key=len)] += tree.text(name).count("\n")
        elif Path(name).parts[0] in SIZED:
            findings.append(f"{name}: a folder without a limit in MOST_LINES")
    return findings + [f"{folder}: {counted[folder]} lines, at most {most}" for folder, most in MOST_LINES.items()
                       if counted[folder] > most]


def house(tree: Tree) -> str:
    """Lines of source and words of pages, beside those of the models."""
    parts = {"tracker": (TRACKER, "include/", "kernels/"), "workbench": WORKBENCH, "Python": "python/",
             "scripts": ("bench/", "scripts/"), "tests": "tests/"}
    found = {part: sum(tree.text(name).count("\n") for name in tree.with_suffix(*SOURCES) if name.startswith(places))
             for part, places in parts.items()}
    found["words of pages"] = sum(len(tree.text(name).split()) for name in tree.with_suffix(".md")
                                  if name.startswith("doc/"))
    return "; ".join(f"{part} {count:,}" + (f" ({MODELS[part]})" if part in MODELS else "")
                     for part, count in found.items())


def check_phrases(tree: Tree) -> list[str]:
    """No page has one of STALE_PHRASES."""
    return [f"{name}:{number}: {found[0]!r}" for name in tree.with_suffix(".md")
            for number, line in enumerate(tree.text(name).split("\n"), 1) if (found := STALE_PHRASES.search(line))]


def check_functions(tree: Tree) -> list[str]:
    """No function beyond LONGEST_FUNCTION lines, unless a comment "LONG: reason" is before it or in it."""
    import lizard

    findings = []
    for name in tree.with_suffix(".cpp", ".hpp", ".cl", ".py"):
        text = tree.text(name)
        lines = text.split("\n")
        # lizard parses OpenCL C as C++.
        shown = name[: -len(".cl")] + ".cpp" if name.endswith(".cl") else name
        for function in lizard.analyze_file.analyze_source_code(shown, text).function_list:
            length = function.end_line - function.start_line + 1
            around = lines[max(function.start_line - 12, 0):function.end_line]
            if length > LONGEST_FUNCTION and not any("LONG: " in line for line in around):
                findings.append(f"{name}:{function.start_line}: {function.name} has {length} lines, "
                                f"at most {LONGEST_FUNCTION} without a comment `LONG: reason`")
    return findings


def stages(tree: Tree) -> list[str]:
    """The stages in the table of variants, in its order."""
    names = re.findall(r'^\s*\{"([a-z_0-9]+)",', tree.text("host/tracker/device/variants.cpp"), re.MULTILINE)
    return list(dict.fromkeys(names))


def check_twins(tree: Tree, show: bool = True) -> list[str]:
    """Kernel and test of a stage have its name, a class opens it, and a header of the plain C++ names its kernel as its
    twin, except for those in the table."""
    excused = {(row[0].strip("`"), what.strip()) for row in tree.table("twins") for what in row[1].split(",")}
    places = {"kernel": "kernels/{}.cl", "class": 'Stage(context, "{}"', "reference": "kernels/{}.cl",
              "test": "tests/test_{}.cpp"}
    texts = {what: "".join(tree.text(name) for name in tree.files if name.startswith(folder))
             for what, folder in (("class", TRACKER + "device/"), ("reference", WORKBENCH))}
    findings = []
    if show:
        print(f"{'stage':22}" + "".join(f"{what:11}" for what in places))
    for stage in stages(tree):
        row = f"{stage:22}"
        for what, pattern in places.items():
            there = pattern.format(stage) in texts.get(what, tree.files)
            row += f"{'yes' if there else ('-' if (stage, what) in excused else 'MISSING'):11}"
            if not there and (stage, what) not in excused:
                findings.append(f"the stage {stage} has no {what} ({pattern.format(stage)})")
            if there and (stage, what) in excused:
                findings.append(f"doc/design.md section 8 says that {stage} has no {what}, but there is one")
        if show:
            print(row)
    for stage, what in sorted(excused):
        if stage not in stages(tree) or what not in places:
            findings.append(f"doc/design.md section 8 excuses {stage}, {what}: there is no such thing")
    return findings


def slug(heading: str) -> str:
    """The anchor of a Markdown heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower().replace("`", "")).replace(" ", "-")


def anchors(text: str) -> set[str]:
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {slug(heading) for heading in headings} | set(re.findall(r'<a name="([^"]+)">', text))


def check_references(tree: Tree) -> list[str]:
    """Sections, files and links in comments and pages exist."""
    findings = []
    sections = {page: set(re.findall(r"^## (\d+)\.", tree.text(f"doc/{page}.md"), re.MULTILINE))
                for page in ("method", "design")}
    written = {"kernel_sources.cpp", "source_commit.cpp"}  # by the build
    path = re.compile(r"(?<![\w./<-])((?:[a-z_]+/)*[a-z_0-9]+\.(?:cl|cpp|hpp|py|sh|md|cmake|toml))(?![\w/])")
    rooted = ("host/", "kernels/", "include/", "tests/", "scripts/", "doc/", "bench/", "cmake/", "examples/")
    for name in tree.with_suffix(".cpp", ".hpp", ".cl", ".py", ".sh", ".md", ".cmake", ".txt"):
        text = tree.text(name)
        for number, line in enumerate(text.split("\n"), 1):
            for page, section in re.findall(r"(method|design)\.md,? section (\d+)", line):
                if section not in sections[page]:
                    findings.append(f"{name}:{number}: doc/{page}.md has no section {section}")
            comment = re.search("//.*" if Path(name).suffix in (".cpp", ".hpp", ".cl") else ".*", line)
            if not comment or line.startswith("#include"):
                continue
            for found in path.findall(comment[0]):
                if Path(found).suffix in (".toml", ".md", ".py", ".sh") and not found.startswith(rooted):
                    continue  # a user's file, or one next to a page
                if found.startswith(rooted):
                    known = found in tree.files or Path(found).name in written
                elif name.endswith((".md", ".py", ".sh", ".txt", ".cmake")):
                    continue
                else:
                    known = any(file == found or file.endswith("/" + found) for file in tree.files) or found in written
                if not known:
                    findings.append(f"{name}:{number}: there is no file {found}")
        if name.endswith(".md"):
            findings += broken_links(tree.root, name, text)
    return findings


def broken_links(root: Path, name: str, text: str) -> list[str]:
    """Links of a page, relative to the root, that lead to no file or heading."""
    findings = []
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.DOTALL)):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        linked = (root / name).parent / file if file else root / name
        if not linked.exists():
            findings.append(f"{name}: the link {target} leads nowhere")
        elif anchor and linked.suffix == ".md" and anchor not in anchors(linked.read_text(encoding="utf-8")):
            findings.append(f"{name}: {target} has no such heading")
    return findings


def check_constants(tree: Tree, program: str) -> list[str]:
    """Constants in doc/method.md exist and have the stated defaults."""
    text = subprocess.run([program, "run", "--help-all"], check=True, capture_output=True, text=True).stdout
    defaults = dict(re.findall(r"--((?:[a-z]+)\.(?:[a-z_0-9]+)) [A-Za-z|]+(?:=([^\s]+))?", text))
    page = tree.text("doc/method.md")
    findings = []
    sections = {name.split(".")[0] for name in defaults}
    for name in sorted(set(re.findall(r"`([a-z]+\.(?!cl`)[a-z_0-9]+)`", page))):
        if name.split(".")[0] in sections and name not in defaults:
            findings.append(f"doc/method.md: there is no constant {name}")
    for name, value in re.findall(r"`([a-z]+\.[a-z_0-9]+)` = \"?(-?[\w.]*\w)", page):
        given = defaults.get(name)
        if given is None:
            continue
        same = float(given) == float(value) if re.match(r"-?[\d.]+$", given) else given == value
        if not same:
            findings.append(f"doc/method.md: {name} is {given}, not {value}")
    return findings


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", type=Path)
    parser.add_argument("checks", nargs="*", metavar="CHECK")
    parser.add_argument("--program")
    options = parser.parse_args()
    tree = Tree(options.repository)
    checks = {"includes": check_includes, "lines": check_lines, "sizes": check_sizes, "phrases": check_phrases,
              "functions": check_functions, "twins": check_twins, "references": check_references}
    if options.program:
        checks["constants"] = lambda tree: check_constants(tree, options.program)
    findings = []
    for check in options.checks or checks:
        if check not in checks:
            parser.error(f"there is no check {check}; there are {', '.join(checks)}")
        found = checks[check](tree)
        print(f"{check}: {len(found)} findings" if found else f"{check}: fine")
        findings += found
    print("\n".join(findings), file=sys.stderr)
    print(house(tree))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
