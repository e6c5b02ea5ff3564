"""The exception for mistakes that a user can fix, and the gate of words."""

from collections.abc import Iterable


class InputError(Exception):
    """A user's mistake: bad scene, bad file, bad option.

    The message is one sentence that names the object, the value, the allowed range and the fix.
    The command line prints it without a traceback and exits with status 2. Whatever it quotes, it
    is one line of characters that can be printed.
    """

    def __init__(self, message: str) -> None:
        line = " ".join(message.split())
        super().__init__(
            "".join(c if c.isprintable() else ascii(c)[1:-1] for c in line)
            if not line.isprintable()
            else line
        )


class MissingToolError(InputError):
    """Something optional that a case needs is not installed; the message says how to get it."""


def require_known(what: str, value: object, known: Iterable[object]) -> None:
    """Refuse a word that is none of the known ones.

    Parameters
    ----------
    what : str
        What the word is of, as "kind of contact".
    value : object
        What is given.
    known : iterable
        All that may be given.

    Raises
    ------
    InputError
        Names them.
    """
    words = list(known)
    if value not in words:
        *first, last = map(repr, words)
        choice = f"{', '.join(first)} or {last}" if first else last
        raise InputError(f"{what} is {value!r}: choose {choice}")


SINGULAR = "the stiffness matrix is singular: the scene is not held everywhere"
