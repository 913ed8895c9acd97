#!/usr/bin/env python3
"""Compiles the kernels that GPUs run by default, and prints registers, stack, spills, local memory and occupancy.
Needs no GPU and measures nothing: a vendor's compiler may do better or worse than clang.

    gpu_budget.py LIST_PROGRAMS            the figures and the kernels that exceed the budget; exit code 1 if any does
    gpu_budget.py LIST_PROGRAMS --write    also writes doc/results/gpu_budget.md

LIST_PROGRAMS is build/tests/list_programs. Needs clang 16 or later with libclc (Debian: clang-19, libclc-19), and for
NVIDIA's figures ptxas from the CUDA toolkit, in PATH or /usr/local/cuda/bin. Exit code 77 if clang is missing; without
ptxas, NVIDIA's figures are omitted with a message.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CLANGS = [f"clang-{version}" for version in range(22, 15, -1)]
PTX_FEATURE = {"sm_75": "+ptx63", "sm_86": "+ptx71", "sm_90": "+ptx78"}
LOWEST_OCCUPANCY = 32  # percent, of kernels that may take more than 5 % of a frame
BUILD_OPTIONS = ["-cl-std=CL1.2", "-cl-fp32-correctly-rounded-divide-sqrt"]  # as the host sets them


@dataclass
class Nvidia:
    """Limits of a streaming multiprocessor (CUDA C++ Programming Guide, table of technical specifications)."""

    warps: int
    groups: int
    shared_bytes: int
    shared_of_group: int  # bytes reserved per group
    registers: int = 65536


NVIDIA = {"sm_75": Nvidia(32, 16, 65536, 0), "sm_86": Nvidia(48, 16, 102400, 1024),
          "sm_90": Nvidia(64, 32, 233472, 1024)}
AMD_WAVES = {"gfx90a": 8, "gfx1100": 16}  # of a SIMD unit (LLVM: User Guide for AMDGPU Backend)

BUDGET_FILE = ROOT / "scripts" / "gpu_budget.txt"


@dataclass
class Figures:
    kernel: str
    target: str
    group: int
    registers: int
    stack: int
    spills: int
    local_bytes: int
    occupancy: float  # percent


def group_of(defines: dict[str, str]) -> int:
    """Work-items per group, as the host derives them from the same defines."""
    if "TILE_X" in defines:
        return int(defines["TILE_X"]) * int(defines["TILE_Y"])
    return int(defines.get("GROUP", defines.get("SCAN_LOCAL", "64")))


def compile_program(clang: str, target: str, line: str, folder: Path) -> str:
    """Compiles a program for a target. Returns the assembly."""
    words = line.split()
    defines = [word for word in words if word.startswith("-D")]
    files = ["common.cl", "layouts.cl"] + [word for word in words if word.endswith(".cl")]
    source = folder / f"{abs(hash((line, target)))}.cl"
    source.write_text("".join((ROOT / "kernels" / name).read_text() + "\n" for name in files))
    if target.startswith("sm_"):
        options = ["-target", "nvptx64-unknown-nvidiacl", "-Xclang", "-target-cpu", "-Xclang", target, "-Xclang",
                   "-target-feature", "-Xclang", PTX_FEATURE[target]]
        library = "nvptx64--nvidiacl.bc"
    else:
        options = ["-target", "amdgcn-unknown-amdhsa", f"-mcpu={target}", "-nogpulib"]
        library = "amdgcn--amdhsa.bc"
    call = [clang, "-x", "cl", *BUILD_OPTIONS, "-O3", "-S", "-o", "-", "-D__OPENCL_VERSION__=120", *options, *defines,
            "-Xclang", "-finclude-default-header", "-Xclang", "-mlink-builtin-bitcode", "-Xclang",
            f"/usr/lib/clc/{library}", str(source)]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{target}: clang refuses {line}\n{done.stderr}")
    return done.stdout


def nvidia_occupancy(target: str, group: int, registers: int, shared: int) -> float:
    limits = NVIDIA[target]
    warps = -(-group // 32)
    registers_of_warp = -(-registers * 32 // 256) * 256
    fits = [limits.groups, limits.warps // warps, limits.registers // (registers_of_warp * warps)]
    if shared > 0:
        fits.append(limits.shared_bytes // (shared + limits.shared_of_group))
    return 100.0 * min(fits) * warps / limits.warps


def nvidia_figures(ptxas: str, target: str, group: int, assembly: str, folder: Path) -> list[Figures]:
    path = folder / f"{abs(hash(assembly))}.ptx"
    path.write_text(assembly)
    done = subprocess.run([ptxas, "-v", "--gpu-name", target, str(path), "-o", "/dev/null"], capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{target}: ptxas fails\n{done.stderr}")
    pattern = re.compile(r"Compiling entry function '(\w+)'.*?(\d+) bytes stack frame, (\d+) bytes spill stores, "
                         r"(\d+) bytes spill loads.*?Used (\d+) registers([^\n]*)", re.DOTALL)
    found = []
    for name, stack, stores, loads, registers, rest in pattern.findall(done.stderr):
        shared = int((re.search(r"(\d+) bytes smem", rest) or [0, "0"])[1])
        found.append(Figures(name, target, group, int(registers), int(stack), int(stores) + int(loads), shared,
                             nvidia_occupancy(target, group, int(registers), shared)))
    return found


def amd_figures(target: str, group: int, assembly: str) -> list[Figures]:
    occupancies = dict(re.findall(r"^(\w+):\s+; @\w+\n.*?^; Occupancy: (\d+)$", assembly, re.MULTILINE | re.DOTALL))
    found = []
    for block in re.split(r"\n  - \.", assembly.split(".amdgpu_metadata")[-1])[1:]:
        def value(key: str, text: str = block) -> str:
            return (re.search(rf"\n    \.{key}:\s+(\S+)", text) or ["", "0"])[1]

        if not (name := value("name")).isidentifier():
            continue  # the version numbers at the end
        found.append(Figures(name, target, group, int(value("vgpr_count")), int(value("private_segment_fixed_size")),
                             int(value("vgpr_spill_count")), int(value("group_segment_fixed_size")),
                             100.0 * int(occupancies[name]) / AMD_WAVES[target]))
    return found


def read_budget() -> dict[str, tuple[bool, bool, int]]:
    """Kernel -> (launched per edge or candidate, may take more than 5 % of a frame, register limit)."""
    budget = {}
    for line in BUDGET_FILE.read_text().split("\n"):
        words = line.split("#")[0].split()
        if words:
            budget[words[0]] = ("edge" in words[2:], "heavy" in words[2:], int(words[1]))
    return budget


def findings(figures: list[Figures], budget: dict[str, tuple[bool, bool, int]]) -> list[str]:
    found = []
    for row in figures:
        where = f"{row.kernel} on {row.target}"
        if row.kernel not in budget:
            found.append(f"{where}: missing in {BUDGET_FILE.name}")
            continue
        per_edge, heavy, registers = budget[row.kernel]
        if row.spills > 0:
            found.append(f"{where}: {row.spills} registers or bytes are spilled; expected none")
        if per_edge and row.stack > 0:
            found.append(f"{where}: {row.stack} bytes of stack; expected none")
        if row.target in NVIDIA and row.registers > registers:
            found.append(f"{where}: {row.registers} registers; expected at most {registers}")
        if heavy and row.occupancy < LOWEST_OCCUPANCY:
            found.append(f"{where}: occupancy of {row.occupancy:.0f} %; expected at least {LOWEST_OCCUPANCY}")
    unknown = budget.keys() - {row.kernel for row in figures}
    found += [f"{BUDGET_FILE.name}: there is no kernel {name}" for name in unknown]
    return sorted(found)


def table(figures: list[Figures], targets: list[str], heavy: set[str]) -> str:
    """One row per kernel, and for each target: registers, stack in bytes, occupancy in percent."""
    cells: dict[str, dict[str, Figures]] = {}
    for row in figures:
        known = cells.setdefault(row.kernel, {}).setdefault(row.target, row)
        if row.registers > known.registers:
            cells[row.kernel][row.target] = row
    lines = ["| kernel | group | local memory | " + " | ".join(targets) + " |", "| --- " * (3 + len(targets)) + "|"]
    for kernel, of_target in sorted(cells.items()):
        first = next(iter(of_target.values()))
        shown = [f"{f.registers}, {f.stack} B, {f.occupancy:.0f} %" for f in (of_target[target] for target in targets)]
        name = f"**{kernel}**" if kernel in heavy else kernel
        lines.append(f"| {name} | {first.group} | {first.local_bytes} B | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


PAGE = """# Compiled kernels for GPUs

Registers per work-item, stack, and occupancy of every kernel that GPUs run by default, compiled with {tools}. These are
properties of the compiled code, not measurements. No kernel spills. Kernels that may take more than 5 % of a frame are
bold. `scripts/gpu_budget.py build/tests/list_programs --write` writes this page; a test enforces
[the budget](../../scripts/gpu_budget.txt).

"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("list_programs", type=Path)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    clang = next((name for name in CLANGS if shutil.which(name)), None)
    if clang is None or not Path("/usr/lib/clc/amdgcn--amdhsa.bc").exists():
        print("skipped: needs clang 16 or later and libclc (Debian: clang-19, libclc-19)")
        return 77
    ptxas = shutil.which("ptxas") or shutil.which("ptxas", path="/usr/local/cuda/bin")
    targets = list(NVIDIA if ptxas else []) + list(AMD_WAVES)
    if not ptxas:
        print("NVIDIA's figures are omitted: ptxas was not found")
    call = [arguments.list_programs, ROOT / "kernels", "gpu"]
    listed = subprocess.run(call, capture_output=True, text=True, check=True)
    programs = listed.stdout.strip().split("\n")

    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
        folder = Path(name)

        def figures_of(job: tuple[str, str]) -> list[Figures]:
            line, target = job
            group = group_of(dict(re.findall(r"-D(\w+)=(\S+)", line)))
            assembly = compile_program(clang, target, line, folder)
            if target in NVIDIA:
                return nvidia_figures(ptxas, target, group, assembly, folder)
            return amd_figures(target, group, assembly)

        figures = sum(pool.map(figures_of, [(line, target) for line in programs for target in targets]), [])
    budget = read_budget()
    heavy = {name for name, (_, is_heavy, _) in budget.items() if is_heavy}
    text = table(figures, targets, heavy)
    print(text)
    if arguments.write:
        version = subprocess.run([clang, "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
        tools = version + (" and ptxas" if ptxas else "")
        (ROOT / "doc" / "results" / "gpu_budget.md").write_text(PAGE.format(tools=tools) + text)
    found = findings(figures, budget)
    print("\n".join(found) or "all kernels are within the budget")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
