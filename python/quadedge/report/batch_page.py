"""The page of a batch: tables over all sequences, and the figures of each."""

from dataclasses import dataclass
from pathlib import Path
from statistics import median

from ..result_files import expecting
from .advice import notices
from .error_tables import ALIGNMENTS, error_table
from .numbers import DASH, exists, share_of, significant
from .page import Detail, Facts, Page, Section, Text, Tile
from .results import DamagedResults, Run, read_json, read_run
from .run_page import facts_of, overview, picture_blocks, plot_sections
from .run_tables import LATENCY, LATENCY_TITLES, origin
from .table import Cell, Table

RAN = ("done", "too few tracked")
MOST_OPEN = 8  # with more sequences, each is folded


@dataclass
class Sequence:
    """A sequence of the batch. If it failed or its results are damaged, `run` is None and `message` says why."""

    entry: dict
    run: Run | None = None
    message: str = ""

    @property
    def name(self) -> str:
        return self.entry["name"]


@dataclass
class Batch:
    """The results of a batch."""

    folder: Path
    summary: dict
    sequences: list[Sequence]


def read_batch(folder: Path) -> Batch:
    """Reads the results in `folder`, without those of damaged sequences. Raises DamagedResults for a summary that
    cannot be read."""
    summary = read_json(folder / "summary.json", "the summary of a batch")
    with expecting("the summary of a batch", folder / "summary.json"):
        return Batch(folder, summary, [_read(folder, entry) for entry in summary["sequences"]])


def _read(folder: Path, entry: dict) -> Sequence:
    if entry["status"] not in RAN:
        return Sequence(entry, message=f"{entry['status']}: {entry['message']}")
    try:
        return Sequence(entry, read_run(folder / "sequences" / entry["name"], entry["name"]))
    except DamagedResults as problem:
        return Sequence(entry, message=f"its results are damaged: {problem}")


def batch_page(batch: Batch, detail: Detail) -> Page:
    """The page of a batch. Damaged sequences are reported, the others shown."""
    blocks = {sequence.name: _sequence_blocks(sequence, detail) for sequence in batch.sequences}
    page = Page(f"Batch report: {batch.folder.resolve().name}", _facts(batch), tiles=_tiles(batch.summary))
    page.sections.append(Section("Overview", _overview(batch.summary, batch.sequences)))
    for name, shown in blocks.items():
        page.sections.append(Section(name, shown, fold=True, open=len(batch.sequences) <= MOST_OPEN))
    return page


def _tiles(summary: dict) -> list[Tile]:
    """Sequences, frames tracked, time per frame, and the drift where there is ground truth."""
    sequences, everything = summary["sequences"], summary["all"]
    done = sum(entry["status"] == "done" for entry in sequences)
    frames, tracked = everything["frames"], everything["frames_tracked"]
    latency = everything["latency_ms"]
    tiles = [Tile("Sequences", f"{done} of {len(sequences)}", "done", warns=done < len(sequences)),
             Tile("Frames tracked", share_of(tracked, frames).partition(" (")[0],
                  f"{frames - tracked} lost" if tracked < frames else "none lost", warns=tracked < frames),
             Tile("Time per frame", f"{significant(latency['median'], 3)} ms",
                  f"median; p99 {significant(latency['p99'], 3)} ms")]
    drifts = [entry["accuracy"]["end_drift_percent"] for entry in sequences if entry.get("accuracy")]
    drifts = [drift for drift in drifts if exists(drift)]
    if drifts:
        tiles.append(Tile("Drift at the end", f"{significant(median(drifts), 2)} %",
                          f"median of {len(drifts)} sequences; largest {significant(max(drifts), 2)} %"))
    return tiles


def _facts(batch: Batch) -> Facts:
    summary = batch.summary
    ran = [entry for entry in summary["sequences"] if entry["status"] in RAN]
    devices = ", ".join(dict.fromkeys(entry["device"] for entry in ran))
    return Facts([*origin(summary, devices, summary.get("input") or str(batch.folder)),
                  ("Sequences", f"{len(ran)} of {len(batch.sequences)} finished"),
                  ("Frames tracked", share_of(summary["all"]["frames_tracked"], summary["all"]["frames"]))])


def _overview(summary: dict, sequences: list[Sequence]) -> list:
    blocks: list = []
    failed = [(sequence.name, sequence.message or f"{sequence.entry['status']}: {sequence.entry['message']}")
              for sequence in sequences if sequence.message or sequence.entry["status"] != "done"]
    if failed:
        blocks += [Text("Failed or incomplete sequences:", warns=True), Facts(failed)]
    rows = [(sequence.name, sequence.entry.get("accuracy")) for sequence in sequences]
    if "pooled" in summary["all"]:
        rows.append(("all, every pose counts alike", summary["all"]["pooled"]))
        tables = [error_table("sequence", rows, alignment) for alignment in ALIGNMENTS]
        for table in tables:
            table.has_result = True
        blocks += tables
    blocks.append(_latency_table(summary, sequences))
    shared = any(sequence.entry.get("jobs", 1) > 1 for sequence in sequences)
    crowd = " Several sequences ran at the same time, which increases latencies."
    blocks.append(Text("Latency is the time from both images in host memory to the pose." + (crowd if shared else "")))
    return blocks


def _latency_table(summary: dict, sequences: list[Sequence]) -> Table:
    table = Table("latency", "Tracked frames and latency", ["sequence", "outcome", "tracked", "keyframes", *(
        ("latency [ms]", title) for title in LATENCY_TITLES)], text_columns=2, has_result=True)
    for entry in [sequence.entry for sequence in sequences] + [{"name": "all", "status": "", "key_rigs": ""}
                                                               | summary["all"]]:
        if "latency_ms" not in entry:
            table.add(entry["name"], entry["status"], *[""] * 7)
            continue
        tracked = Cell(share_of(entry["frames_tracked"], entry["frames"]), entry["frames_tracked"])
        table.add(entry["name"], entry["status"], tracked, entry["key_rigs"],
                  *[Cell.of(entry["latency_ms"][key]) for key in LATENCY])
    return table


def _sequence_blocks(sequence: Sequence, detail: Detail) -> list:
    """What a sequence shows; what is damaged sets its message."""
    entry = sequence.entry
    try:
        if sequence.run is None:
            return [Text(sequence.message, warns=True)]
        with expecting("the report of a run", sequence.run.folder / "report.json"):
            facts = [("Recording", f"{entry['path']} ({entry['format']})"),
                     ("Command", sequence.run.report.get("command") or DASH), *facts_of(sequence.run)]
            figures = [block for section in plot_sections(sequence.run, detail) for block in section.blocks
                       if block.kind == "figures"]
            return [Facts(facts), *notices(sequence.run), *overview(sequence.run, detail), *figures,
                    *picture_blocks(sequence.run, detail)]
    except DamagedResults as problem:
        sequence.message = f"its results are damaged: {problem}"
        return [Text(sequence.message, warns=True)]
