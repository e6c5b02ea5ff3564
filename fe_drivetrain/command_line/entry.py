"""The program's first moments: Ctrl-C ends it properly even while its commands are being loaded."""

from __future__ import annotations

from fe_drivetrain.command_line.terminal import ended


def main() -> None:
    """Entry point of ``fe-drivetrain``; ends with its exit status."""
    ended(_commands)


def _commands() -> None:
    from fe_drivetrain.command_line.app import main

    main()
