"""What a notebook in the repository keeps of what it showed: the same bytes after every run, and small.

A picture stands in place of a live page, which a viewer of repositories does not run, and beside the words of a result,
whose own HTML has it inside. Cells of code and outputs belong together by a hash in the notebook's metadata.
"""

from __future__ import annotations

import base64
import hashlib
import html
import io
import json
import os
import re
from collections.abc import Callable
from typing import Any

Photograph = Callable[[str], bytes]
"""From a page's HTML to a picture of it, as PNG."""

COLOURS = (128, 64)
LARGEST_PICTURE = 100_000
"""Bytes of a picture that is kept; larger ones lose colours, then size. Colours next to each other are joined first, so
that a small bright patch keeps its own."""

FRAME = re.compile(r'<iframe srcdoc="([^"]*)"')
INSIDE = re.compile(r'<img src="data:image/png;base64,([^"]+)" alt="([^"]*)"/>')
WARNING = re.compile(r"^\S*ipykernel_\d+\S*: (\w+: .*)\n(?:  .*\n)?", re.MULTILINE)
"""As Python prints it: the kernel's file and line, what is meant, the line of the cell."""


def plain(text: str, folder: str) -> str:
    """Printed text without the places where it was printed, which are elsewhere each time."""
    return WARNING.sub(r"\1\n", text).replace(f"{folder}{os.sep}", "")


def code_hash(cells: list[Any]) -> str:
    """SHA-256 of the cells of code, in their order: outputs of one depend on all before it."""
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    return hashlib.sha256(json.dumps(code, ensure_ascii=False).encode("utf-8")).hexdigest()


def small(png: bytes) -> bytes:
    """The picture in few colours, without what the file says of its maker; narrower where it stays too large."""
    import PIL.Image

    image = PIL.Image.open(io.BytesIO(png))
    if "A" in image.getbands():
        ground = PIL.Image.new("RGBA", image.size, "white")
        image = PIL.Image.alpha_composite(ground, image.convert("RGBA"))
    image = image.convert("RGB")
    while True:
        for colours in COLOURS:
            file = io.BytesIO()
            few = image.quantize(colours, PIL.Image.Quantize.MAXCOVERAGE, dither=PIL.Image.Dither.NONE)
            few.save(file, "PNG", optimize=True)
            if file.tell() <= LARGEST_PICTURE:
                return file.getvalue()
        image = image.resize((image.width * 3 // 4, image.height * 3 // 4), PIL.Image.Resampling.LANCZOS)


def kept(book: Any, folder: str, photograph: Photograph) -> Any:
    """The notebook as it is kept, changed in place: outputs, the hash of its code, and nothing that differs by run."""
    for cell in book["cells"]:
        cell["metadata"].pop("execution", None)
        if cell["cell_type"] == "code":
            outputs = [one for output in cell["outputs"] for one in _parts(output, photograph)]
            cell["outputs"] = [_plain(output, folder) for output in _merged(outputs)]
    book["metadata"]["language_info"] = {"name": "python"}
    book["metadata"]["geocontact"] = {"code_sha256": code_hash(book["cells"])}
    return book


def _parts(output: Any, photograph: Photograph) -> list[Any]:
    """The output, what it shows as HTML taken apart into words and pictures."""
    data = output.get("data", {})
    shown = "".join(data.get("text/html", ""))
    frame, inside = FRAME.search(shown), INSIDE.search(shown)
    if frame is not None:
        data.pop("text/html")
        data["image/png"] = _encoded(photograph(html.unescape(frame[1])))
    elif inside is not None:
        data["text/html"] = INSIDE.sub("", shown)
        drawn = {"image/png": _encoded(base64.b64decode(inside[1])), "text/plain": html.unescape(inside[2])}
        return [output, type(output)(output_type="display_data", data=drawn, metadata={})]
    elif "image/png" in data:
        data["image/png"] = _encoded(base64.b64decode(data["image/png"]))
    return [output]


def _encoded(png: bytes) -> str:
    return base64.b64encode(small(png)).decode("ascii")


def _merged(outputs: list[Any]) -> list[Any]:
    """Pieces of one stream that follow each other as one: where it was cut depends on the moment."""
    merged: list[Any] = []
    for output in outputs:
        if merged and output["output_type"] == "stream" and merged[-1].get("name") == output["name"]:
            merged[-1]["text"] += output["text"]
        else:
            merged.append(output)
    return merged


def _plain(output: Any, folder: str) -> Any:
    if "text" in output:
        output["text"] = plain(output["text"], folder)
    for kind in {"text/plain", "text/html"} & set(output.get("data", ())):
        output["data"][kind] = output["data"][kind].replace(f"{folder}{os.sep}", "")
    return output
