"""Pictures of results, by matplotlib where it is installed."""
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ._traces import Traces

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN = 3
"""Logs of a picture unless more are asked for."""


def plot(traces: Traces, units: Mapping[str, str], title: str, logs: Sequence[str] | None,
         channels: Sequence[str] | None) -> "Figure":
    """Measured (dots) and simulated (line) outputs over time [s]."""
    try:
        from matplotlib import pyplot
    except ModuleNotFoundError as error:
        raise ImportError("plot() needs matplotlib: pip install matplotlib") from error
    logs = list(traces)[:SHOWN] if logs is None else _known(logs, list(traces), "log")
    of_logs = [name for log in logs for name in traces[log] if f"{name}_measured" in traces[log]]
    outputs = list(dict.fromkeys(of_logs))
    channels = outputs if channels is None else _known(channels, outputs, "channel")
    if not logs or not channels:
        raise ValueError("plot() has nothing to draw: the job wrote no simulated logs")
    figure, axes = pyplot.subplots(len(channels), len(logs), squeeze=False, sharex="col",
                                   sharey="row", layout="constrained",
                                   figsize=(1 + 3.5 * len(logs), 1 + 2 * len(channels)))
    for row, channel in zip(axes, channels):
        for axis, log in zip(row, logs):
            _draw(axis, traces[log], channel)
        unit = units.get(channel)
        row[0].set_ylabel(f"{channel} [{unit}]" if unit else channel)
    for top, bottom, log in zip(axes[0], axes[-1], logs):
        top.set_title(log)
        bottom.set_xlabel("time [s]")
    axes[0][0].legend()
    figure.suptitle(title)
    return figure


def _draw(axis, trace, channel):
    axis.plot(trace["time"], trace[f"{channel}_measured"], ".", color="0.6", markersize=3,
              label="measured")
    axis.plot(trace["time"], trace[channel], color="C0", label="simulated")


def _known(names: Sequence[str], there: list[str], what: str) -> list[str]:
    names = [names] if isinstance(names, str) else list(names)
    for name in names:
        if name not in there:
            raise ValueError(f"plot(): expected a {what} of {', '.join(there)}; found {name!r}")
    return names
