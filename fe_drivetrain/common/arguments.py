"""Arguments of functions, as sentences for a user name them.

A sentence names an argument as Python has it, between backticks: "`every=10` leaves 2 samples".
The command line puts the option that stands for it in its place, see
`fe_drivetrain.command_line.option_names`, so that each reader finds the name that is theirs to
give.
"""

from __future__ import annotations


def argument(name: str, value: object = ...) -> str:
    """The argument as Python has it, between backticks.

    Parameters
    ----------
    name : str
        Its name; behind a dot where it is a field of a class of options, as in
        "LifeOptions.temperature".
    value : object
        What it is or should be, as plain data; left out where the name alone is meant.

    Returns
    -------
    text : str
        As "`every=10`", or "`LifeOptions(temperature=60.0)`".
    """
    owner, _, field = name.rpartition(".")
    given = "..." if value is ... else repr(value).replace("`", r"\x60")
    if owner:
        return f"`{owner}({field}={given})`"
    return f"`{field}`" if value is ... else f"`{field}={given}`"
