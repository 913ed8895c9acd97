"""Makes report pages and parses them."""

import base64
import gzip
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
from PIL import Image
from quadedge import report
from quadedge.report.page import LARGEST_PAGE


class ParsedPage(HTMLParser):
    """Tables by title, terms, plots, images, and everything that would be loaded from elsewhere."""

    def __init__(self, text: str):
        super().__init__()
        self.tables: dict[str, list[list[str]]] = {}
        self.bold: list[str] = []
        self.facts: dict[str, str] = {}
        self.pictures = 0
        self.plots: list[str] = []
        self.outside: list[str] = []
        self.links: list[str] = []
        self.title = ""
        self.tiles: dict[str, str] = {}  # "value remark" by name
        self.figures: list[dict] = []
        self.text = ""
        self._open: list[str] = []
        self._title = self._term = ""
        self._script = ""
        self.feed(text)
        self.close()
        assert not self._open, f"never closed: {self._open}"

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        for key in ("src", "href", "action", "srcset", "poster", "data"):
            address = values.get(key, "")
            if tag == "a" and address and not address.startswith("#"):
                self.links.append(address)  # followed by a reader, not loaded
            elif address and not address.startswith(("data:image/", "#")):
                self.outside.append(f"{tag} {key}={address}")
        if tag in ("link", "iframe", "object", "embed"):
            self.outside.append(tag)
        if tag == "img":
            self.pictures += 1
        if "data-figure" in values:
            self.plots.append(values["id"])
        if tag in ("meta", "img", "wbr", "br"):
            return
        self._open.append(tag)
        if tag == "table":
            self.tables[self._title] = []
        elif tag == "tr":
            self.tables[self._title].append([])
        elif tag in ("td", "th"):
            self.tables[self._title][-1].append("")
            if "best" in values.get("class", ""):
                self.bold.append("")
        elif tag == "figcaption":
            self._title = ""
        elif tag in ("dt",):
            self._term = ""
        elif tag == "script":
            self._script = values.get("id", "code")
        self._best = tag in ("td", "small") and ("best" in values.get("class", "") or tag == "small" and self._best)

    def handle_endtag(self, tag):
        assert self._open and self._open[-1] == tag, f"</{tag}> closes {self._open[-3:]}"
        self._open.pop()

    def handle_data(self, data):
        inside = self._open[-1] if self._open else ""
        if inside == "script":
            if self._script == "data-of-figures":
                self.figures = json.loads(gzip.decompress(base64.b64decode(data)))
            return
        if inside == "style":
            return
        self.text += data
        if inside == "h1":
            self.title += data
        if self._open[-3:-1] == ["ul", "li"] and inside == "span":
            self._tile = data
            self.tiles[data] = ""
        elif inside in ("strong", "small") and self._open[-3:-1] == ["ul", "li"]:
            self.tiles[self._tile] = f"{self.tiles[self._tile]} {data}".strip()
        if "table" in self._open and {"td", "th"} & set(self._open):
            self.tables[self._title][-1][-1] += data
            if self._best and inside == "td":
                self.bold[-1] += data
        elif inside == "figcaption":
            self._title += data
        elif inside == "dt":
            self._term += data
        elif inside == "dd":
            self.facts[self._term] = self.facts.get(self._term, "") + data

    def row(self, title: str, first: str) -> list[str]:
        """The row of a table that begins with `first`."""
        return next(row for row in self.tables[title] if row[0] == first)

    def figure(self, name: str) -> dict:
        """A plot's data and layout, by the end of its name."""
        number = next(i for i, plot in enumerate(self.plots) if plot.endswith(name))
        return self.figures[number]

    def traces(self, figure: str) -> dict[str, dict]:
        """A plot's curves by their names."""
        return {trace["name"]: trace for trace in self.figure(figure)["data"]}


def page_of(path: Path, **options) -> ParsedPage:
    """The page of results, which loads nothing from elsewhere and shows no value that is none."""
    text = report.make_page(path, **options).read_text(encoding="utf-8")
    assert len(text.encode()) < LARGEST_PAGE
    page = ParsedPage(text)
    assert page.outside == []
    assert all(re.fullmatch(r"file://.*/doc/[a-z0-9-]+\.md(#[a-z0-9-]+)?", link) for link in page.links)
    assert "default-src 'none'" in text  # so that the browser refuses network access
    assert not {"nan", "None", "NaN", "inf", "Undefined"} & set(page.text.split())
    return page


def save_picture(file: Path, width: int, height: int) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (height, width, 3), dtype=np.uint8)
    Image.fromarray(noise).save(file)
