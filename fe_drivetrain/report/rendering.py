"""What all pages share: templates in which every string is data, the style, and their scripts.

A page asks nothing of any network; its content-security policy forbids that, and any script but the
project's own.
"""

from __future__ import annotations

import base64
import hashlib
import shlex
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote

import jinja2
from markupsafe import Markup, escape

from fe_drivetrain.common.typeset import typeset
from fe_drivetrain.report.number_text import (
    band_text,
    computed_text,
    error_text,
    expected_text,
    formatted,
    given_text,
    safe_range,
    tolerance_text,
)

_TEMPLATES = Path(__file__).parent / "templates"


def templates() -> jinja2.Environment:
    """The templates of pages, with the filters that all of them use."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        # of plain strings alone: what is Markup is scripts, styles, and what is to be typed again
        finalize=lambda value: printed(value) if type(value) is str else value,
    )
    shared: dict[str, Callable[..., str]] = {
        "seconds": _seconds,
        "percent": lambda share: formatted(100 * share, 3),
        "given": given_text,
        "band": band_text,
        "computed": computed_text,
        "expected": expected_text,
        "error": error_text,
        "tolerance": tolerance_text,
        "safe_range": safe_range,
        "page_of": lambda case: Markup(f"{quote(case)}/report.html"),
        "address": lambda path: Markup(quote(path)),  # of a scheme as javascript: a file's name
        "as_typed": escape,
        "as_word": lambda text: escape(shlex.quote(text)),
        "plain": lambda text: escape(typeset(text.replace("`", ""))),  # in attributes
    }
    environment.filters |= shared
    environment.globals["style"] = read_template("report.css")
    return environment


def read_template(name: str) -> Markup:
    """A style or script of the project's own: never a string of the results."""
    return Markup((_TEMPLATES / name).read_text(encoding="utf-8"))


def policy_hash(script: str) -> Markup:
    """How a content-security policy names a script that stands on the page."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return Markup(f"'sha256-{digest}'")


def _seconds(seconds: float) -> str:
    if 0.0 < seconds < 0.01:
        return "<\u00a00.01"
    return f"{seconds:.3g}" if seconds < 1000 else f"{seconds:.0f}"


def printed(text: str) -> str:
    """Text as a page prints it; what stands between backticks is code, and stays as it is."""
    if text.count("`") % 2 or "`" not in text:
        return typeset(text)
    parts = [
        Markup("<code>{}</code>").format(part) if i % 2 else escape(typeset(part))
        for i, part in enumerate(text.split("`"))
    ]
    return Markup("").join(parts)
