"""Makes pages of QuadEdge's results: self-contained files with tables, interactive plots and pictures.

The input is the output of `quadedge run`, `quadedge batch` and `python -m quadedge.matching --json`; images are not
processed. Needs jinja2, plotly and matplotlib, but not the compiled part of the package.
"""

import importlib.util
from pathlib import Path

from .page import Page, smallest_loss, write_atomically, write_figures, write_markdown, write_tables
from .results import DamagedResults

if importlib.util.find_spec("plotly") is None:  # its JavaScript is read without importing it
    raise ModuleNotFoundError("No module named 'plotly'", name="plotly")

__all__ = ["DamagedResults", "Page", "make_page"]


def make_page(results: str | Path, output: str | Path | None = None, *, comparison: str | Path | None = None,
              markdown: str | Path | None = None, csv: str | Path | None = None, latex: str | Path | None = None,
              figures: str | Path | None = None) -> Path:
    """Makes the page of a run, of a batch, or of a file of `python -m quadedge.matching --json`, and returns its path.

    results: folder of a run or batch, or the JSON file. output: path of the page; by default `report.html` in the
    folder, or the JSON file's name with .html. comparison: file that `quadedge report --baseline --peer` writes about a
    batch. markdown: file to write the tables of the first section to. csv, latex: folders to write every table to.
    figures: folder to write every figure to, as SVG and PDF.

    Raises DamagedResults for results that cannot be read; a single damaged sequence of a batch is reported on the page.
    Raises OSError for a file that cannot be written.
    """
    from .batch_page import batch_page, read_batch
    from .matching_page import matching_page, read_matching
    from .results import read_run
    from .run_page import run_page

    results = Path(results)
    if results.is_file():
        content, page_of = read_matching(results), matching_page
    elif (results / "summary.json").is_file():
        content, page_of = read_batch(results, comparison and Path(comparison)), batch_page
    else:
        content, page_of = read_run(results), run_page
    output = Path(output or (results.with_suffix(".html") if results.is_file() else results / "report.html"))
    page, text = smallest_loss(lambda detail: page_of(content, detail))
    write_atomically(output, text)
    if markdown:
        write_markdown(page, Path(markdown))
    for folder, ending in ((csv, "csv"), (latex, "tex")):
        if folder:
            write_tables(page, Path(folder), ending)
    if figures:
        write_figures(page, Path(figures))
    return output
