"""Regular files alone are read: a pipe, a device or a socket may have no end, or never begin.

So is standard input where it is a pipe (``/dev/stdin``): what is read twice, or by a library that
takes a name, must be a file. A link counts as what it leads to.
"""

from __future__ import annotations

import os
import stat
from io import BufferedReader
from pathlib import Path

MAX_BYTES = 300_000_000
"""Largest size of a file that is read whole, where nothing else is said [bytes]."""

_KINDS = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


class NotRegularError(OSError):
    """What has this name is no regular file; the message says what it is."""


class TooLargeError(OSError):
    """A file that is read whole has more bytes than it may have, which it is made of."""

    def __init__(self, most: int) -> None:
        super().__init__(f"it has more than {most} bytes, the most that is read of such a file")


def opened(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a regular file for reading bytes; it never waits.

    Parameters
    ----------
    path : str or path-like
        Its name, or that of a link to it.

    Returns
    -------
    file
        To be closed.

    Raises
    ------
    OSError
        It cannot be opened.
    NotRegularError
        It is a pipe, a device or a socket.
    """
    require_regular(path)  # before it is opened, which can change what a device does
    file = open(path, "rb", opener=_without_waiting)  # noqa: SIM115 - it is handed out
    try:
        _require_regular(os.fstat(file.fileno()), path)  # it may have been exchanged meanwhile
    except OSError:
        file.close()
        raise
    return file


def require_regular(path: str | os.PathLike[str], most: int | None = None) -> None:
    """Refuse what is no regular file, before a library opens it by its name.

    Parameters
    ----------
    path : str or path-like
        The file.
    most : int or None
        Bytes that it may have.

    Raises
    ------
    OSError
        It cannot be looked at, or is a folder.
    NotRegularError
        It is a pipe, a device or a socket.
    TooLargeError
        It has more bytes.
    """
    status = os.stat(path)
    _require_regular(status, path)
    if most is not None and status.st_size > most:
        raise TooLargeError(most)


def content_of(path: str | os.PathLike[str], most: int = MAX_BYTES) -> bytes:
    """All bytes of a regular file.

    Parameters
    ----------
    path : str or path-like
        The file.
    most : int
        Bytes that it may have.

    Raises
    ------
    OSError
        The same as for `opened`.
    TooLargeError
        It has more bytes.
    """
    with opened(path) as file:
        too_large = os.fstat(file.fileno()).st_size > most
        content = b"" if too_large else file.read(most + 1)
    if too_large or len(content) > most:  # it may have grown meanwhile
        raise TooLargeError(most)
    return content


def text_of(path: str | os.PathLike[str], most: int = MAX_BYTES, encoding: str = "utf-8") -> str:
    r"""The text of a regular file, whose lines end with ``\n`` however they end in the file.

    Raises
    ------
    OSError
        The same as for `content_of`.
    UnicodeDecodeError
        It is not text of this encoding.
    """
    text = content_of(path, most).decode(encoding)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _require_regular(status: os.stat_result, path: str | os.PathLike[str]) -> None:
    if stat.S_ISREG(status.st_mode):
        return
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(f"{Path(path)} is a folder")
    what = _KINDS.get(stat.S_IFMT(status.st_mode), "no regular file")
    raise NotRegularError(f"it is {what}, which may have no end")


def _without_waiting(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
