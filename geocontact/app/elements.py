"""Plain elements of HTML with texts that are never markup, as the pages of the window are made of."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any

from nicegui import context
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement

from geocontact.app.gate import RESULT

ADDRESSES = ("href", "src", "data_to")
"""Attributes that hold one."""


def element(tag: str, classes: str = "", **attributes: Any) -> Element:
    """An element that holds others; `class_` and `for_` in `attributes` are class and for."""
    made = Element(tag)
    _attributed(made, classes, attributes)
    return made


def text(tag: str, words: str, classes: str = "", **attributes: Any) -> TextElement:
    """An element that holds a text."""
    made = TextElement(tag=tag, text=words)
    _attributed(made, classes, attributes)
    return made


def link(words: str, address: str, classes: str = "", **attributes: Any) -> TextElement:
    """A link of this server."""
    return text("a", words, classes, href=address, **attributes)


def choice(values: Iterable[tuple[str, str]], chosen: str, **attributes: Any) -> Element:
    """A list of values with their words, one of which is chosen; as one text, since each element costs its time."""
    options = (
        f'<option value="{escape(value)}"{" selected" if value == chosen else ""}>{escape(words)}</option>'
        for value, words in values
    )
    return element("select", innerHTML="".join(options), **attributes)


def below_home(address: str) -> str:
    """An address of the window below the path of its pages; one of results stays."""
    if not address.startswith("/") or address.startswith(RESULT):
        return address
    return f"{context.client.request.scope.get('root_path', '')}{address}"


def _attributed(made: Element, classes: str, attributes: dict[str, Any]) -> None:
    if classes:
        made.classes(classes)
    for name, value in attributes.items():
        if name in ADDRESSES:
            value = below_home(value)
        made.props[name.rstrip("_").replace("_", "-")] = value
