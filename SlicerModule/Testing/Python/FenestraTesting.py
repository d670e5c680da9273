"""Helpers of the tests in Python."""

import pathlib
import re
import time

import qt
import slicer


def process_events():
    """Waits longer than the timers of Slicer's new views, then for the events that they caused."""
    loop = qt.QEventLoop()
    qt.QTimer.singleShot(500, loop.quit)
    loop.exec_()
    for _ in range(5):
        slicer.app.processEvents()


def wait_for(condition, seconds=120):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        process_events()
    return condition()


def read_examples():
    """The tutorial's examples in Python, by their headings."""
    text = (pathlib.Path(__file__).parents[2] / "Tutorial.md").read_text()
    examples = re.findall(r"^### ([^\n]*)\n((?:(?!\n#).)*?)```python\n(.*?)```", text, re.DOTALL | re.MULTILINE)
    return {heading: code for heading, _, code in examples}


def type_example(code):
    """Runs code with the names that Slicer's Python console has, and returns all names."""
    names = {}
    exec("from slicer.util import *\nimport ctk, qt, slicer, vtk", names)
    exec(code, names)
    return names


class Log:
    """Lines that Slicer's error log gained, as a context: all of a level."""

    def __enter__(self):
        self.model = slicer.app.errorLogModel()
        self.before = self.model.logEntryCount()
        return self

    def __exit__(self, *_):
        pass

    def lines(self):
        process_events()
        return [self.model.logEntryDescription(row) for row in range(self.before, self.model.logEntryCount())]
