"""Texts that must stay texts, and a page made of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.view.page.content import (
    Choices,
    Curves,
    Limit,
    Mark,
    Page,
    PageChoice,
    Plan,
    Points,
    Readout,
    Row,
    Scene,
    Strip,
    Table,
    Words,
)

HOSTILE = [
    "<script>window.hacked=1</script>",
    "</script><script>window.hacked=2</script>",
    "<img src=x onerror=window.hacked=3>",
    '" onload="window.hacked=4',
    "' onclick='window.hacked=5",
    '"><svg onload=window.hacked=6>',
    "</title><script>window.hacked=7</script>",
    "</style><script>window.hacked=8</script>",
    "<!-- <script>",
    "-->",
    "]]>",
    "javascript:window.hacked=9",
    "data:text/html,<script>window.hacked=10</script>",
    "../../../../etc/passwd",
    "..\\..\\windows\\system32",
    "${window.hacked=11}",
    "{{ window.hacked }}",
    "{% include 'x' %}",
    "{# comment #}",
    "#{window.hacked=12}",
    "`window.hacked=13`",
    "&lt;b&gt;",
    "&amp;amp;",
    "&#60;script&#62;",
    "\u202egnp.exe",
    "\u2067right to left\u2069",
    "a\u200bb\ufeffc",
    "line\u2028separator\u2029paragraph",
    "%3Cscript%3E%00",
    "\\u003cscript\\u003e",
    "constructor",
    "__proto__",
    "x" * 400,
]


def hostile_page(page: Page, names: list[str]) -> Page:
    """The same page with a hostile text wherever a text may stand."""
    it = [names[k % len(names)] for k in range(200)]

    def renamed(section: object, k: int) -> object:
        match section:
            case Scene():
                bodies = [replace(body, name=it[k + i]) for i, body in enumerate(section.bodies)]
                directions = {f"{it[k + i]}": v for i, v in enumerate(section.directions.values())}
                return replace(section, bodies=bodies, value_name=it[k + 7], directions=directions)
            case Curves():
                curves = [replace(curve, name=it[k + i]) for i, curve in enumerate(section.curves)]
                points, limits = [Points(it[k + 3], np.zeros(1), np.ones(1))], [Limit(it[k + 4], 1.0)]
                return Curves(it[k + 1], it[k + 2], curves, points, limits)
            case Strip():
                return replace(section, title=it[k], unit=it[k + 1])
            case Plan():
                tracks = [replace(track, name=it[k + i]) for i, track in enumerate(section.tracks)]
                marks = [Mark(it[k + 3], (0.0, 0.0))]
                lengths = [replace(each, name=it[k + 1], told=it[k + 2]) for each in section.lengths]
                return Plan(it[k], it[k + 1], it[k + 2], it[k + 3], section.lines, tracks, marks, lengths, it[k + 4])
            case Readout():
                rows = [
                    Row(it[k], it[k + 1], [it[(k + f) % 200] for f in range(len(row.texts))]) for row in section.rows
                ]
                return Readout(rows, it[k + 3])
            case Table():
                return Table(it[k], list(names), [list(names), list(reversed(names))])
            case Words():
                return Words(it[k], list(names))
        raise AssertionError(section)

    sections = [renamed(section, 5 * k) for k, section in enumerate(page.sections)]
    facts = list(zip(names, reversed(names), strict=True))
    return replace(
        page,
        title=names[0],
        subtitle=names[1],
        time_label=names[2],
        headline=names,
        facts=facts,
        reservations=names,
        sections=sections,  # type: ignore[arg-type]
        choices=Choices(names[0], names[1], [PageChoice(names[2], names, facts, {1: sections[1]})]),  # type: ignore[dict-item]
    )
