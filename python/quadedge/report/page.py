"""Pages as data, and their rendering to self-contained HTML files."""

import base64
import functools
import gzip
import html
import io
import json
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import metadata, resources
from pathlib import Path
from urllib.parse import quote

import jinja2
from markupsafe import Markup

from .figure import Figure, rounded
from .table import Table, to_markdown

LARGEST_PAGE = 6_000_000  # bytes


@dataclass(frozen=True)
class Detail:
    """The level of detail of a page."""

    points: int
    """Points per curve."""
    picture_width: int
    """Width of a thumbnail [px]; 0: no pictures."""
    quality: int
    """JPEG quality of the pictures."""


# In order of preference; the first one that makes the page small enough is used.
DETAILS = (Detail(2000, 480, 75), Detail(600, 480, 60), Detail(300, 320, 55), Detail(200, 260, 50),
           Detail(120, 200, 45), Detail(60, 0, 0))


@dataclass
class Facts:
    """Terms and their descriptions or values."""

    entries: list[tuple[str, str]]
    kind: str = "facts"


@dataclass
class Text:
    """A paragraph, highlighted if `warns` is set."""

    text: str
    warns: bool = False
    kind: str = "text"


@dataclass
class Figures:
    """Plots side by side, with an optional caption below."""

    figures: list[Figure]
    caption: str = ""
    kind: str = "figures"


@dataclass
class Picture:
    """An encoded JPEG and its caption."""

    data: bytes
    caption: str

    @property
    def address(self) -> str:
        return "data:image/jpeg;base64," + base64.b64encode(self.data).decode()


@dataclass
class Pictures:
    """Small pictures side by side, or large ones (`wide`) one below the other."""

    pictures: list[Picture]
    wide: bool = False
    kind: str = "pictures"


@dataclass
class Tile:
    """A figure that matters most, large, between what it is and a remark."""

    name: str
    value: str
    remark: str = ""
    warns: bool = False


@dataclass
class Notice:
    """A box with what a reader has to know: (what was found, what to do) in each entry."""

    title: str
    entries: list[tuple[str, str]]
    kind: str = "notice"


@dataclass
class Columns:
    """Blocks side by side, below one another on a narrow screen."""

    blocks: list
    kind: str = "columns"


@dataclass
class Section:
    """A heading and its blocks. With `fold` they are hidden until clicked, and open in print. `explained`: the page of
    the documentation that explains it, such as "accuracy.md#presets"."""

    title: str
    blocks: list = field(default_factory=list)
    level: int = 2
    fold: bool = False
    open: bool = False
    explained: str = ""


@dataclass
class Page:
    """The content of a page: below its title a sentence (`lead`) and tiles, at its end `facts`, the origin of its
    figures, in a fold."""

    title: str
    facts: Facts
    sections: list[Section] = field(default_factory=list)
    lead: str = ""
    tiles: list[Tile] = field(default_factory=list)

    def blocks(self, kind: str) -> list:
        blocks = [block for section in self.sections for block in section.blocks]
        blocks = [inner for block in blocks for inner in (block.blocks if block.kind == "columns" else [block])]
        return [block for block in blocks if block.kind == kind]

    def tables(self) -> list[Table]:
        return self.blocks("table")

    def figures(self) -> list[Figure]:
        return [figure for block in self.blocks("figures") for figure in block.figures]


def reduced(file: Path, width: int, quality: int) -> bytes | None:
    """The picture as a JPEG of at most this width [px]; None if the file is not a readable image."""
    import PIL.Image

    try:
        with PIL.Image.open(file) as opened:
            picture = opened.convert("RGB")
    except (OSError, SyntaxError, ValueError, PIL.Image.DecompressionBombError):
        return None
    if picture.width > width:
        picture = picture.resize((width, max(1, round(picture.height * width / picture.width))),
                                 PIL.Image.Resampling.LANCZOS)
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=quality)
    return stream.getvalue()


def _packed(content: bytes) -> Markup:
    """Compressed and encoded as text, to be unpacked by the browser."""
    return Markup(base64.b64encode(gzip.compress(content, 9, mtime=0)).decode())


@functools.cache
def _plotly_code() -> Markup:
    """plotly's minified source, packed to a third of its size."""
    return _packed((resources.files("plotly") / "package_data" / "plotly.min.js").read_bytes())


def _emphasised(text: str) -> Markup:
    """The escaped text, with line breaks allowed after the slashes of paths."""
    return Markup(html.escape(text, quote=False).replace("/", "/<wbr>"))


@functools.cache
def _documentation() -> str:
    """Its address: a folder of this machine, or ""."""
    checkout, installed = Path(__file__).resolve().parents[3], Path(sys.prefix) / "share/doc/quadedge"
    for folder in (checkout / "doc", installed / "doc"):
        if (folder / "reference.md").is_file():
            return "file://" + quote(str(folder)) + "/"
    return ""


def explanation_of(page: str) -> tuple[str, str]:
    """Address of a page such as "accuracy.md#presets", "" if there is none, and how to call it."""
    address = _documentation()
    return address and address + page, "doc/" + page.partition("#")[0]


def to_html(page: Page) -> str:
    """The page as HTML."""
    environment = jinja2.Environment(loader=jinja2.PackageLoader("quadedge.report"), autoescape=True,
                                     trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["breakable"] = _emphasised
    environment.filters["explanation"] = explanation_of
    figures = page.figures()
    files = resources.files("quadedge.report") / "templates"
    return environment.get_template("page.html.j2").render(
        page=page, numbers={id(figure): number for number, figure in enumerate(figures)}, id=id,
        style=Markup((files / "page.css").read_text(encoding="utf-8")),
        script=Markup((files / "page.js").read_text(encoding="utf-8")),
        figures=_packed(json.dumps([figure.plotly() for figure in figures], separators=(",", ":"),
                                   allow_nan=False, default=rounded).encode()),
        plotly=_plotly_code() if figures else "", plotly_version=metadata.version("plotly"))


def write_atomically(file: Path, text: str) -> None:
    """Writes a file completely or not at all."""
    temporary = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        temporary.write_text(text, encoding="utf-8", errors="replace")
        temporary.replace(file)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def smallest_loss(make: Callable[[Detail], Page]) -> tuple[Page, str]:
    """The page with the highest level of detail that stays below LARGEST_PAGE, and its HTML."""
    for detail in DETAILS:
        page = make(detail)
        if detail is not DETAILS[0]:
            page.sections[-1].blocks.append(Text("Curves are thinned and pictures reduced so that this page stays "
                                                 "small."))
        text = to_html(page)
        if len(text.encode("utf-8", "replace")) <= LARGEST_PAGE:
            break
    return page, text


def write_tables(page: Page, folder: Path) -> None:
    """Writes the unrounded values of every table as FOLDER/NAME.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    for table in page.tables():
        write_atomically(folder / f"{table.name}.csv", table.frame("value").to_csv(index=False))


def write_markdown(page: Page, file: Path) -> None:
    """Writes what the first section says and tabulates as Markdown."""
    parts = [f"# {page.title}\n"]
    for block in page.sections[0].blocks:
        if block.kind == "table":
            parts.append(f"## {block.title}\n\n{to_markdown(block)}")
        elif block.kind == "facts":
            parts.append("".join(f"- {term}: {text}\n" for term, text in block.entries))
        elif block.kind == "text":
            parts.append(f"{block.text}\n")
    write_atomically(file, "\n".join(parts))
