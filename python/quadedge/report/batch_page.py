"""The page of a batch: tables over all sequences, and the figures of each."""

from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from .batch_summary import pooled
from .error_tables import ALIGNMENTS, ErrorRow, error_table
from .numbers import difference, exists, length_text, share_of, significant
from .origin import origin
from .page import Detail, Facts, Page, Section, Text, Tile
from .results import DamagedResults, Errors, Run, aligned, read_json, read_run, read_tum
from .run_page import NO_PLOTS, picture_blocks, plots
from .run_tables import LATENCY, LATENCY_TITLES
from .sequence_figures import Other
from .table import Cell, Table

RAN = ("done", "too few tracked")
MOST_OPEN = 8  # with more sequences, each is folded


@dataclass
class Sequence:
    """A sequence of the batch. If it failed or its results are damaged, `run` is None and `message` says why."""

    entry: dict
    compared: dict
    run: Run | None = None
    message: str = ""
    others: list[Other] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def name(self) -> str:
        return self.entry["name"]

    @property
    def accuracy(self) -> dict | None:
        return self.entry.get("accuracy")


@dataclass
class Batch:
    """The results of a batch and an optional comparison with other systems."""

    folder: Path
    summary: dict
    compared: dict
    sequences: list[Sequence]


def read_batch(folder: Path, comparison: Path | None) -> Batch:
    """Reads the results in `folder`, without those of damaged sequences. Raises DamagedResults for a summary or a
    comparison that cannot be read."""
    summary = read_json(folder / "summary.json", "the summary of a batch")
    if "sequences" not in summary or "all" not in summary:
        raise DamagedResults(f"{folder / 'summary.json'}: no `sequences`; expected the summary of a batch")
    compared = read_json(comparison, "the comparison of a batch") if comparison else {"sequences": []}
    by_name = {entry["name"]: entry for entry in compared["sequences"]}
    sequences = [_read(folder, entry, by_name.get(entry["name"], {})) for entry in summary["sequences"]]
    return Batch(folder, summary, compared, sequences)


def batch_page(batch: Batch, detail: Detail) -> Page:
    """The page of a batch. Damaged sequences are reported, the others shown."""
    page = Page(f"Batch report: {batch.folder.resolve().name}", _facts(batch), tiles=_tiles(batch.summary))
    page.sections.append(Section("Overview", _overview(batch.summary, batch.sequences)))
    for sequence in batch.sequences:
        page.sections.append(Section(sequence.name, _sequence_blocks(sequence, detail), fold=True,
                                     open=len(batch.sequences) <= MOST_OPEN))
    return page


def _read(folder: Path, entry: dict, compared: dict) -> Sequence:
    sequence = Sequence(entry, compared, notes=list(compared.get("notes", [])))
    if entry["status"] not in RAN:
        sequence.message = f"{entry['status']}: {entry['message']}"
        return sequence
    try:
        sequence.run = read_run(folder / "sequences" / entry["name"], entry["name"])
    except DamagedResults as problem:
        sequence.message = f"its results are damaged: {problem}"
        return sequence
    reference = sequence.run.truth or sequence.run.estimate
    for system in compared.get("systems", []):
        try:
            poses = aligned(read_tum(Path(system["file"])), reference)
        except DamagedResults as problem:
            sequence.notes.append(f"{system['name']}: {problem}")
            continue
        if poses is None:
            sequence.notes.append(f"{system['name']}: no pose has a timestamp of this sequence")
            continue
        sequence.others.append(Other(system["name"], poses, _errors(system.get("per_pose"))))
    return sequence


def _errors(columns: dict | None) -> Errors | None:
    if not columns:
        return None
    texts = {name: ["" if value is None else str(value) for value in values] for name, values in columns.items()}
    return Errors.of(texts, Path("comparison.json"))


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
    summary, compared, sequences = batch.summary, batch.compared, batch.sequences
    ran = [sequence.entry for sequence in sequences if sequence.entry["status"] in RAN]
    devices = ", ".join(dict.fromkeys(entry["device"] for entry in ran))
    facts = origin(summary, devices, summary.get("input") or str(batch.folder))
    facts.append(("Sequences", f"{len(ran)} of {len(sequences)} finished"))
    facts.append(("Frames tracked", share_of(summary["all"]["frames_tracked"], summary["all"]["frames"])))
    if compared.get("baseline"):
        facts.append(("Baseline", f"{compared['baseline']}; differences to it are in brackets; (=) means none at this "
                                  "precision"))
    for peer in compared.get("peers", []):
        facts.append(("Compared with", f"{peer['name']} ({peer['folder']})"))
    return Facts(facts)


def _overview(summary: dict, sequences: list[Sequence]) -> list:
    blocks: list = []
    failed = [(sequence.name, sequence.message or f"{sequence.entry['status']}: {sequence.entry['message']}")
              for sequence in sequences if sequence.message or sequence.entry["status"] != "done"]
    if failed:
        blocks += [Text("Failed or incomplete sequences:", warns=True), Facts(failed)]
    if any(sequence.accuracy for sequence in sequences):
        groups = [_error_rows(sequence) for sequence in sequences]
        groups.append(_rows_over_all(summary, sequences))
        blocks += [error_table(groups, alignment) for alignment in ALIGNMENTS]
    blocks.append(_latency_table(summary, sequences))
    shared = any(sequence.entry.get("jobs", 1) > 1 for sequence in sequences)
    crowd = " Several sequences ran at the same time, which increases latencies."
    blocks.append(Text("Latency is the time from both images in host memory to the pose." + (crowd if shared else "")))
    return blocks


def _error_rows(sequence: Sequence) -> list[ErrorRow]:
    baseline = sequence.compared.get("baseline", {}).get("accuracy")
    rows = [ErrorRow(sequence.name, "QuadEdge", sequence.accuracy, baseline)]
    for system in sequence.compared.get("systems", []):
        if system.get("accuracy"):
            rows.append(ErrorRow(sequence.name, system["name"], system["accuracy"]))
    return rows


def _rows_over_all(summary: dict, sequences: list[Sequence]) -> list[ErrorRow]:
    own_sequences = sum(sequence.accuracy is not None for sequence in sequences)
    title = "all sequences, poses weighted equally"
    baselines = [sequence.compared["baseline"]["accuracy"] for sequence in sequences
                 if sequence.accuracy and "accuracy" in sequence.compared.get("baseline", {})]
    baseline = pooled(baselines) if baselines and len(baselines) == own_sequences else None
    rows = [ErrorRow(title, "QuadEdge", summary["all"].get("pooled"), baseline)]
    for name, parts in _accuracies(sequences).items():
        if name != "baseline" or baseline:  # one that lacks sequences is of other data
            rows.append(ErrorRow(title, f"{name}, {len(parts)} sequences", pooled(parts),
                                 ranked=len(parts) == own_sequences))
    return rows


def _accuracies(sequences: list[Sequence]) -> dict[str, list[dict]]:
    """Of every other system, over its sequences."""
    found: dict[str, list[dict]] = {}
    for sequence in sequences:
        for system in sequence.compared.get("systems", []):
            if system.get("accuracy"):
                found.setdefault(system["name"], []).append(system["accuracy"])
    return found


def _latency_table(summary: dict, sequences: list[Sequence]) -> Table:
    table = Table("latency", "Tracked frames and latency",
                  ["sequence", "outcome", "tracked", "keyframes", *LATENCY_TITLES], text_columns=2)
    table.groups = [("", 1), ("", 1), ("", 1), ("", 1), ("latency [ms]", 5)]
    table.exact_columns = [name.replace("keyframes", "key rigs") for name in table.full_columns()]  # as in older files
    for sequence in sequences:
        entry, baseline = sequence.entry, sequence.compared.get("baseline")
        if entry["status"] not in RAN:
            table.add(sequence.name, entry["status"], *[""] * 7)
            continue
        tracked = Cell(share_of(entry["frames_tracked"], entry["frames"]), entry["frames_tracked"])
        if baseline and baseline["frames_tracked"] != entry["frames_tracked"]:
            tracked.beside = f"({entry['frames_tracked'] - baseline['frames_tracked']:+d})"
        latency, before = entry["latency_ms"], baseline["latency_ms"] if baseline else {}
        table.add(sequence.name, entry["status"], tracked, entry["key_rigs"],
                  *[Cell.of(latency[key], beside=difference(latency[key], before.get(key))) for key in LATENCY])
    everything = summary["all"]
    table.add("all", "", Cell(share_of(everything["frames_tracked"], everything["frames"]),
                              everything["frames_tracked"]), "",
              *[Cell.of(everything["latency_ms"][key]) for key in LATENCY])
    table.result_rows = 1
    return table


def _sequence_blocks(sequence: Sequence, detail: Detail) -> list:
    run = sequence.run
    if run is None:
        return [Text(sequence.message, warns=True)]
    facts = [("Recording", f"{sequence.entry['path']} ({sequence.entry['format']})"),
             ("Command", run.report.get("command") or "\u2013"),
             ("Frames tracked", share_of(sequence.entry["frames_tracked"], sequence.entry["frames"]))]
    if sequence.accuracy:
        facts.append(("Path", f"{length_text(sequence.accuracy['path_length_m'])}, drift at its end "
                              f"{significant(sequence.accuracy['end_drift_percent'], 2)} %"))
    facts += [("Note", note) for note in sequence.notes]
    blocks: list = [Facts(facts)]
    blocks += [Text(f"Frame {warning['frame']}: {warning['text']}", warns=True) for warning in run.report["warnings"]]
    blocks += [block for _, part in plots(run, sequence.others, detail) for block in part] or [NO_PLOTS]
    return blocks + picture_blocks(run, detail)
