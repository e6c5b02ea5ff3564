"""Formulas of the pages as MathML: a browser shows them without a script and without a network.

Pages have them as ``$...$``, or in a block of the language ``math``, as repository hosts show them.
"""

from __future__ import annotations

import re

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

STYLE = "formulas.css"
"""Style sheet beside this file."""

FUNCTIONS = re.compile(r"<mi>(arctan|cos|cot|exp|ln|log|sin|tan)</mi>")
"""They are upright, with a space on either side."""

log = logging.getLogger(__name__)


def mathml(formula: str, block: bool = False) -> str:
    """A formula of LaTeX as MathML.

    Parameters
    ----------
    formula : str
        Between the dollars.
    block : bool
        Whether it has a line of its own.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If the formula has a command that is not known, or brackets that do not close.
    """
    # what the library has by another name, and letters that stand upright
    known = formula.replace("{aligned}", "{align*}").replace(r"\mathrm{", r"\text{")
    if formula.count("{") != formula.count("}"):
        raise ValueError(f"{formula!r} has braces that do not close")
    try:
        text = convert(known, display="block" if block else "inline")
    except Exception as error:  # each fault has a class of its own
        raise ValueError(f"{formula!r} is no formula: {type(error).__name__} {error}") from error
    if unknown := re.search(r"\\\w*", text):
        raise ValueError(f"{formula!r} has {unknown[0]!r}, which is not known")
    return FUNCTIONS.sub(r'<mo lspace="0.17em" rspace="0.17em">\1</mo>', text)


def formulas(page: str) -> list[tuple[str, bool]]:
    """Formulas of a page of Markdown, each with whether it is a block."""
    blocks = re.findall(r"^```math\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    text = re.sub(r"^ *(```|:::).*?^ *\1", "", page, flags=re.DOTALL | re.MULTILINE)
    inside = re.findall(r"\$([^$]+)\$", re.sub(r"`[^`]*`", "", text))
    return [(block, True) for block in blocks] + [(formula, False) for formula in inside]


def visit_formula(self: HTML5Translator, node: nodes.Element) -> None:
    """Write a formula; one that cannot be read is warned of and stands as it is."""
    block = isinstance(node, nodes.math_block)
    try:
        text = mathml(node.astext(), block)
    except ValueError as refusal:
        log.warning(str(refusal), location=node)
        text = f"<code>{self.encode(node.astext())}</code>"
    self.body.append(f'<div class="formula">{text}</div>\n' if block else text)
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer, which ``html_math_renderer`` names."""
    app.add_html_math_renderer("mathml", (visit_formula, None), (visit_formula, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
