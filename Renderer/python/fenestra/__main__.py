"""`python3 -m fenestra`: the command line program."""

import os
import sys

from ._batch import PROGRAM


def main() -> None:
    os.execv(PROGRAM, [str(PROGRAM), *sys.argv[1:]])


if __name__ == "__main__":
    main()
