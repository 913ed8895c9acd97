"""Makes pages of QuadEdge's results: self-contained files with tables, interactive plots and pictures.

The input is the output of `quadedge run` and `quadedge batch`; images are not processed. Needs jinja2, pandas and
plotly, but not the compiled part of the package.
"""

import importlib.util
from pathlib import Path

from ..result_files import expecting
from .page import Page, smallest_loss, write_atomically, write_markdown, write_tables
from .results import DamagedResults

if importlib.util.find_spec("plotly") is None:  # its JavaScript is read without importing it
    raise ModuleNotFoundError("No module named 'plotly'", name="plotly")

__all__ = ["DamagedResults", "Page", "make_page"]


def make_page(results: str | Path, output: str | Path | None = None, *, markdown: str | Path | None = None,
              csv: str | Path | None = None) -> Path:
    """Makes the page of a run or of a batch, and returns its path.

    results: its folder. output: path of the page; by default `report.html` in the folder. markdown: file to write the
    tables of the first section to. csv: folder to write every table to.

    Raises DamagedResults for results that cannot be read; a single damaged sequence of a batch is reported on the page.
    Raises OSError for a file that cannot be written.
    """
    from .batch_page import batch_page, read_batch
    from .results import read_run
    from .run_page import run_page

    results = Path(results)
    if (results / "summary.json").is_file():
        file, read, page_of = results / "summary.json", read_batch, batch_page
    else:
        file, read, page_of = results / "report.json", read_run, run_page
    content = read(results)
    with expecting("what this version writes", file):
        page, text = smallest_loss(lambda detail: page_of(content, detail))
    output = Path(output or results / "report.html")
    write_atomically(output, text)
    if markdown:
        write_markdown(page, Path(markdown))
    if csv:
        write_tables(page, Path(csv))
    return output
