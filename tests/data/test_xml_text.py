"""Text in XML is that of the standard library, and read back as it was."""

from __future__ import annotations

from xml.etree import ElementTree as ET
from xml.sax import saxutils

from hypothesis import example, given
from hypothesis import strategies as st

from geocontact.data.xml_text import escape, quoteattr

KINDS = st.text(st.sampled_from("a\"'&<>\n\r\t;#ü ]"))


@given(KINDS)
@example("'both \" kinds'")
@example("&amp;")
def test_text_is_that_of_the_standard_library(text: str) -> None:
    assert escape(text) == saxutils.escape(text)
    assert quoteattr(text) == saxutils.quoteattr(text)


@given(KINDS)
@example("'both \" kinds'")
def test_an_attribute_is_read_back(text: str) -> None:
    assert ET.fromstring(f"<a b={quoteattr(text)}/>").attrib["b"] == text
