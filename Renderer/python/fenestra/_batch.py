"""fenestra.batch: the command `fenestra batch`, in a process of its own."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, Optional

from . import _fenestra

PROGRAM = Path(__file__).with_name("fenestra")

_FILES = ("input", "segmentation", "labels", "preset", "transfer", "materials", "lights", "environment")  # of columns
_KINDS = {2: "request", 3: "input"}  # by exit status; else output


class BatchRow(NamedTuple):
    """Result of a row of the table."""

    name: str
    image: Path  #: the .png; beside it are the other formats
    error: Optional[str]  #: None: the row is done
    seconds: Optional[float]  #: that its render took; None: it failed

    @property
    def statistics(self) -> Dict[str, Any]:
        """Times, counts and measurements, as of --stats-json."""
        statistics: Dict[str, Any] = json.loads(self.image.with_suffix(".json").read_text("utf-8"))
        return statistics


def _flatten(value: Any) -> List[str]:
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        return [str(value).replace(",", "\\,")]
    return [text for one in value for text in _flatten(one)]


def _arguments(key: str, value: Any) -> List[str]:
    """A keyword as on the command line."""
    option = "--" + key.replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [option]
    if isinstance(value, dict):
        return [f"{option}={json.dumps(value)}"]
    if key == "material":
        return [f"{option}={text}" for text in ([value] if isinstance(value, str) else value)]
    if isinstance(value, (str, os.PathLike)):
        return [f"{option}={os.fspath(value)}"]
    return [option + "=" + ("x" if key == "size" else ",").join(_flatten(value))]


def _to_cell(column: str, value: Any) -> str:
    """A value as in a table, whose empty cells are None or, of pandas, NaN. A table's files are relative to it."""
    if value is None or value != value:
        return ""
    is_file = column in _FILES and isinstance(value, (str, os.PathLike)) and os.path.exists(value)
    return ",".join(_flatten(os.path.abspath(value) if is_file else value))


def _write_table(table: Any, folder: Path) -> Path:
    """Writes rows, or a table of pandas, to a file beside the results."""
    rows: List[Dict[str, Any]] = table.to_dict("records") if hasattr(table, "to_dict") else [dict(row) for row in table]
    columns = list(dict.fromkeys(column for row in rows for column in row))
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "rows.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(column.replace("_", "-") for column in columns)
        writer.writerows([_to_cell(column, row.get(column)) for column in columns] for row in rows)
    return path


def batch(table: Any, output: Any = None, **options: Any) -> Iterator[BatchRow]:
    """Renders the rows of a table, each in a process of its own, and returns results as rows end, in this order.

    Columns of the table, a .csv file, are `name`, `input` and options of the command line (Renderer/program/README.md,
    Batches). A list of dicts, or a table of pandas, is written to rows.csv in `output`.
    `output` is the folder of the results, by default the table's name without .csv. The other keywords are options of
    `fenestra batch`, with _ for -: workers, formats, restart, and those of a render, for all rows whose cell is empty.

    Rows that are done, with the same options and files, are not rendered again, and rows that were stopped resume. To
    end the loop early stops the rows under way.

    Raises fenestra.Error for a wrong table or option; a row that fails has BatchRow.error instead.
    """
    is_file = isinstance(table, (str, os.PathLike))
    if output is None and not is_file:
        raise ValueError("output: is required for rows that are not in a file")
    folder = Path(output) if output is not None else Path(table).with_suffix("")
    path = os.fspath(table) if is_file else str(_write_table(table, folder))
    words = [f"--output={folder}", "--verbose", "--progress=none"]
    words += [word for key, value in options.items() for word in _arguments(key, value)]
    result = re.compile(r"(?P<name>[^:]+): (?P<seconds>[0-9.e+-]+) s(, rendered before)?")
    failure = re.compile(r"fenestra: warning: (?P<name>[^:]+): (?P<error>.*)")
    last, failed = "", False
    with subprocess.Popen(
        [str(PROGRAM), "batch", *words, "--", path],
        stdin=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        errors="replace",
    ) as process:
        try:
            assert process.stderr
            for line in process.stderr:
                last = line.rstrip("\n")
                found = result.fullmatch(last) or failure.fullmatch(last)
                if found:
                    values = found.groupdict()
                    name, error, seconds = found["name"], values.get("error"), values.get("seconds")
                    failed = failed or error is not None
                    yield BatchRow(name, folder / name / f"{name}.png", error, float(seconds) if seconds else None)
        finally:
            if process.poll() is None:
                process.terminate()  # writes what it has
    if process.returncode and not failed:
        error = _fenestra.Error(last)
        error.kind, error.detail = _KINDS.get(process.returncode, "output"), last
        raise error
