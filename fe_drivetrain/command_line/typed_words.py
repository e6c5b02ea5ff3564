"""Words of a command line that no argument takes: said with what was probably meant."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

# typer has its own copy of click, of which it shows this alone
_UsageError: Any = typer.BadParameter.__base__


class WithFiles(TyperCommand):
    """A command that explains files of a pattern which the shell has written out."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words; where files are left over, say how several are given.

        Parameters
        ----------
        ctx : click.Context
            Of this command.
        args : list of str
            What was typed.

        Returns
        -------
        list of str
        """
        typed = list(args)
        try:
            return super().parse_args(ctx, args)
        except _UsageError as error:
            left = error.message.partition("extra argument")[2]
            if left and any(Path(word).exists() and word in left for word in typed):
                ctx.fail(
                    f"{error.message}: put a pattern in quotes, as in --loads 'outputs/*.outb', "
                    "give the folder, or repeat the option before each file"
                )
            raise
