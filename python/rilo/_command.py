"""The rilo command: the program that the package carries takes the place of Python."""

import os
import sys
from pathlib import Path


def main() -> None:
    """Starts the command with the arguments of this process; returns only as an error."""
    program = Path(__file__).parent / "bin" / "rilo"
    try:
        os.execv(program, ["rilo", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"rilo: error: {program}: {error.strerror}. Install the package again")
