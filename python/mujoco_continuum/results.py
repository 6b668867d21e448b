"""What the tools found, as objects.

A result is the JSON document that the tool writes, as a dict (`fit["parameters"]`), and has the
same as attributes with types and units (`fit.parameters["damping"].interval`). The attributes are
those of the document as it came. A number that the document lacks is nan.
"""
import dataclasses
import math
import pathlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ._experiment import StrPath
from ._extend import extended
from ._plot import plot
from ._traces import Traces, read_traces

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from mujoco import MjSpec

Json = Mapping[str, Any]


class Interval(NamedTuple):
    """A 95 % interval, in the unit of its number."""

    low: float
    high: float

    def contains(self, value: float) -> bool:
        return self.low <= value <= self.high


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A fitted number. Of a cause only name, value, unit, interval, fine_step and
    if_numbers_are_off are given."""

    name: str
    value: float
    unit: str
    interval: Interval | None
    """None where the fit has none."""
    standard_error: float = math.nan
    lower: float = -math.inf
    upper: float = math.inf
    start: float = math.nan
    at_bound: bool = False
    fine_step: float | None = None
    """What a fit at a time step of zero would give; None where that is not known."""
    if_numbers_are_off: float | None = None
    """What lengths and masses of the model that are 1.5 % off may add to it (one standard
    deviation); None where that is not known."""

    def __str__(self) -> str:
        around = "" if self.interval is None else " (95 %: {:.4g} … {:.4g})".format(*self.interval)
        return f"{self.name} {self.value:.4g} {self.unit}{around}"


@dataclasses.dataclass(frozen=True)
class Cause:
    """What the simulation gets wrong, where, and by how much."""

    effect: str
    """Of the list of effects(), such as "payload"."""
    where: str
    """Such as "body tip"; of a law that is a formula, its text."""
    parameters: dict[str, Parameter]
    probability: float
    """Among the candidates tried; the document says of what, under "probability_is"."""
    equivalent: list[str]
    """Effects that do as well."""
    evidence: str

    def __str__(self) -> str:
        return f"{self.effect} at {self.where}: {_joined(self.parameters.values())}"


@dataclasses.dataclass(frozen=True)
class Errors:
    """RMS of simulated minus measured over all rows, channels and logs of a use."""

    train: float
    validate: float
    unit: str
    """Of the channels; "std": each channel was divided by its standard deviation."""

    def __str__(self) -> str:
        return f"train {self.train:.4g}, validate {self.validate:.4g} {self.unit}"


@dataclasses.dataclass(frozen=True)
class Channel:
    """How far one output of one log is off, in its own unit."""

    log: str
    use: str
    """train | validate."""
    name: str
    unit: str
    rows: int
    rmse: float
    nrmse: float
    """rmse by the standard deviation of the measured rows."""
    fit_percent: float


@dataclasses.dataclass(init=False, repr=False, eq=False)
class Result(dict[str, Any]):
    """The document of a job, and what it says as attributes."""

    traces: Traces
    """Of each log the columns of its simulated/LOG.csv: "time" [s], each output as simulated, and
    as measured ("NAME_measured"), in the unit of the log."""

    def __init__(self, document: Json, folder: StrPath | None = None):
        super().__init__(document)
        self.traces = read_traces(pathlib.Path(folder, "simulated")) if folder is not None else {}

    def summary(self) -> str:
        """One line that says the most important."""
        raise NotImplementedError

    def plot(self, logs: Sequence[str] | None = None,
             channels: Sequence[str] | None = None) -> "Figure":
        """Measured and simulated outputs over time, a column for each log, a row for each channel.

        Without names: the first three logs, all channels. Needs matplotlib."""
        units = {channel.name: channel.unit for channel in getattr(self, "channels", ())}
        return plot(self.traces, units, self.summary(), logs, channels)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.summary()}>"


@dataclasses.dataclass(init=False, repr=False, eq=False)
class Replay(Result):
    """How far the model is off as it stands: errors.json."""

    error: Errors
    channels: list[Channel]

    def __init__(self, document: Json, folder: StrPath | None = None):
        super().__init__(document, folder)
        self.error = _errors(document, document.get("unit"))
        self.channels = _channels(document)

    def summary(self) -> str:
        return f"error {self.error}"


@dataclasses.dataclass(init=False, repr=False, eq=False)
class Fit(Result):
    """Fitted parameters: fit.json."""

    parameters: dict[str, Parameter]
    error: Errors
    channels: list[Channel]
    correlation: list[list[float]]
    """In the order of the parameters."""
    converged: bool
    message: str
    """Why the fit ended."""

    def __init__(self, document: Json, folder: StrPath | None = None):
        super().__init__(document, folder)
        error = document.get("error", {})
        self.parameters = _parameters(document.get("parameters", ()))
        self.error = _errors(error, error.get("unit"))
        self.channels = _channels(error)
        self.correlation = document.get("correlation", [])
        self.converged = document["converged"]
        self.message = document["message"]

    def summary(self) -> str:
        return f"{_joined(self.parameters.values())}; error {self.error}"


@dataclasses.dataclass(init=False, repr=False, eq=False)
class Diagnosis(Result):
    """Why the simulation is off, and the extended model: diagnosis.json."""

    verdict: str
    """adequate | named | ambiguous | unexplained."""
    certainty: str
    """sure | likely | cannot say."""
    reason: str
    causes: list[Cause]
    """They act together."""
    parameters: dict[str, Parameter]
    """Of the extended model, those of the experiment and those of the causes."""
    before: Errors
    after: Errors
    """Of the extended model as it runs."""
    gain: float
    """Share of the held-out error that the extension removes."""
    gain_interval: Interval | None

    def __init__(self, document: Json, folder: StrPath | None = None):
        super().__init__(document, folder)
        error, gain = document["error"], document["gain"]
        self.verdict = document["verdict"]
        self.certainty = document.get("certainty", "")
        self.reason = document.get("reason", "")
        self.causes = [_cause(cause) for cause in document["causes"]]
        self.parameters = _parameters(document.get("parameters", ()))
        self.before = _errors(error["before"], error["unit"])
        self.after = _errors(error["after"], error["unit"])
        self.gain = _number(gain["validate_error_removed"])
        self.gain_interval = _interval(gain["ci95"])

    def summary(self) -> str:
        causes = " and ".join(str(cause) for cause in self.causes)
        return (f"{self.verdict} ({self.certainty}){': ' if causes else ''}{causes}; validate "
                f"error {self.before.validate:.4g} -> {self.after.validate:.4g} {self.after.unit}")

    def apply(self, model: "MjSpec | StrPath") -> "MjSpec":
        """The model with the extension.

        model: a specification, or the path of an MJCF file; it stays as it is.

        Raises InputError where the model lacks what the extension acts on."""
        return extended(self, model)


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _interval(ends: Sequence[float | None] | None) -> Interval | None:
    return Interval(*ends) if ends and None not in ends else None


def _joined(parameters) -> str:
    return ", ".join(str(parameter) for parameter in parameters)


def _errors(error: Json, unit: str | None) -> Errors:
    return Errors(_number(error.get("train")), _number(error.get("validate")), unit or "")


def _parameters(documents: Sequence[Json]) -> dict[str, Parameter]:
    return {p["name"]: Parameter(p["name"], _number(p["value"]), p["unit"], _interval(p["ci95"]),
                                 _number(p["standard_error"]), p["lower"], p["upper"], p["start"],
                                 p["at_bound"], _fine_step(p)) for p in documents}


def _fine_step(parameter: Json) -> float | None:
    return parameter.get("fine_step")


def _cause(document: Json) -> Cause:
    parameters = {name: Parameter(name, _number(p["value"]), p["unit"], _interval(p["ci95"]),
                                  fine_step=_fine_step(p),
                                  if_numbers_are_off=p.get("if_numbers_are_off"))
                  for name, p in document["parameters"].items()}
    return Cause(document["effect"], document["where"], parameters,
                 _number(document["probability"]), document["equivalent"], document["evidence"])


def _channels(error: Json) -> list[Channel]:
    return [Channel(log["log"], log["use"], c["channel"], c["unit"], c["rows"], _number(c["rmse"]),
                    _number(c["nrmse"]), _number(c["fit_percent"]))
            for log in error.get("logs", ()) for c in log["channels"]]
