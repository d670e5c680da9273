"""Progress of a render: a bar of tqdm, or a function of the user."""

from __future__ import annotations

import contextlib
import importlib
import sys
import warnings
from typing import Any, Callable, Iterator, Optional, Union

Progress = Union[None, bool, Callable[[float, float, float], object]]
Callback = Callable[[float, float, float], object]


def _in_notebook() -> bool:
    get_ipython = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)
    return hasattr(get_ipython(), "kernel")


@contextlib.contextmanager
def callback(progress: Progress) -> Iterator[Optional[Callback]]:
    """The function that a render calls. `progress` None: a bar in terminals and notebooks, if tqdm is installed."""
    if callable(progress):
        yield progress
        return
    is_shown = progress if progress is not None else _in_notebook() or bool(sys.stderr and sys.stderr.isatty())
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a notebook without widgets, which gets a bar of text
            tqdm = importlib.import_module("tqdm.auto").tqdm if is_shown else None
    except ImportError:
        if progress:
            raise
        tqdm = None
    if not tqdm:
        yield None
        return
    with contextlib.ExitStack() as bars:
        bar: Any = None

        def update(fraction: float, seconds: float, noise: float) -> None:
            nonlocal bar
            if not bar:  # not before the arguments were accepted
                bar = bars.enter_context(
                    tqdm(total=100, desc="prepare", bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}{postfix}")
                )
            if fraction > 0.0:
                bar.set_description_str("render", refresh=False)
            if noise < float("inf"):
                bar.set_postfix_str(f"noise {noise:.2g}", refresh=False)
            bar.update(100.0 * fraction - bar.n)
            bar.refresh()  # the time, also while nothing else changes

        yield update
