"""``python -m quadedge.batch OUT``: runs what OUT/batch.json names, and summarises it. Started by `quadedge batch`."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from ..report.batch_summary import is_finished, read_plan, summarise_batch
from ..shell import exit_code
from . import NEEDED  # noqa: F401  says what is missing before anything is written
from .sequence import die_with_parent

INTERRUPTIONS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def snakemake_command(out: Path, plan: dict, options: argparse.Namespace) -> list[str]:
    """Options of the user come last: they win. Failed and damaged sequences are repeated."""
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(Path(__file__).with_name("Snakefile")),
             "--directory", str(out), "--nolock", "--rerun-incomplete", "--rerun-triggers", "params", "--keep-going"]
    if not options.snakemake:
        words += ["--cores", str(plan["jobs"])]
    if options.dry_run:
        words.append("--dry-run")
    members = [f"sequences/{sequence['name']}/member.json" for sequence in plan["sequences"]]
    again = [member for member in members if (out / member).exists() and not is_finished((out / member).parent)]
    if options.force:
        words.append("--forceall")
    elif again:
        words += ["--forcerun", *again]
    hidden = ["host"] if options.dry_run else ["all"] if options.quiet else ["host", "rules", "reason"]
    return [*words, "--quiet", *hidden, *options.snakemake]


class Interrupted(Exception):
    """A signal asked the batch to end."""


def run_snakemake(command: list[str]) -> int:
    """Its exit code. A signal is passed on to it and to its jobs, which end at once. Raises Interrupted."""
    received = []

    def interrupt(number: int, _frame: object) -> None:
        os.killpg(process.pid, signal.SIGINT if not received else signal.SIGKILL)
        received.append(number)

    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, process_group=0, preexec_fn=die_with_parent)
    for number in INTERRUPTIONS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, interrupt)
    code = process.wait()
    if received:
        raise Interrupted(received[0])
    return code


def run_batch(options: argparse.Namespace) -> int:
    out = options.out
    plan = read_plan(out)
    names = [sequence["name"] for sequence in plan["sequences"]]
    if not options.dry_run:
        shutil.rmtree(out / "unfinished", ignore_errors=True)  # of a batch that was killed; the lock is held alone
    try:
        code = run_snakemake(snakemake_command(out, plan, options))
    except Interrupted as interruption:
        done = sum(is_finished(out / "sequences" / name) for name in names)
        print(f"quadedge: interrupted; {done} of {len(names)} sequences finished, results in {out / 'sequences'}; "
              "repeat the command to go on", file=sys.stderr, flush=True)
        shutil.rmtree(out / "unfinished", ignore_errors=True)
        signal.signal(interruption.args[0], signal.SIG_DFL)
        os.kill(os.getpid(), interruption.args[0])
    if options.dry_run or code > 1:  # 2: options that it does not know
        return code
    shutil.rmtree(out / "unfinished", ignore_errors=True)
    return summarise_batch(out, plan) or code


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m quadedge.batch", description="Runs a batch with Snakemake.",
                                     usage="%(prog)s [OPTION...] OUT [-- OPTION OF SNAKEMAKE...]")
    parser.add_argument("out", type=Path, metavar="OUT", help="folder with the batch.json of `quadedge batch`")
    parser.add_argument("--dry-run", action="store_true", help="print what would be run")
    parser.add_argument("--force", action="store_true", help="repeat finished sequences")
    parser.add_argument("--quiet", action="store_true", help="hide progress")
    words = sys.argv[1:]
    own = words[:words.index("--")] if "--" in words else words
    options = parser.parse_args(own)
    options.snakemake = words[len(own) + 1:]
    return exit_code("quadedge", lambda: run_batch(options))


if __name__ == "__main__":
    sys.exit(main())
