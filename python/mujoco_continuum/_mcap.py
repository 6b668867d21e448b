"""MCAP recordings as columns."""
import json
import pathlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import ModuleType
from typing import IO, Any

import numpy

from ._tables import listed
from ._tool import InputError
from .reading import Columns, needed

CLOCKS = ("log", "publish", "header")
LONGEST = 1000
"""Numbers of a list that become columns; longer ones are pictures and the like."""
SUPPORTS = {"cdr": "mcap_ros2.decoder", "protobuf": "mcap_protobuf.decoder"}


def read_mcap(path: pathlib.Path, topics: Sequence[str] | None, clock: str) -> Columns:
    if clock not in CLOCKS:
        raise InputError(f"clock: expected {listed(CLOCKS)}, found {clock!r}")
    reader = needed("mcap.reader", f"reading {path}", "mcap")
    rows: dict[int, dict[str, float]] = {}
    factories: dict[str, Any] = {}
    with open(path, "rb") as stream:
        for schema, channel, message in _messages(reader, stream, path, topics):
            decoder = _decoder(schema, channel, path, factories, required=topics is not None)
            if decoder is None:
                continue
            content = decoder(message.data)
            time = _time(content, message, clock, f"{path}, {channel.topic}")
            rows.setdefault(time, {}).update(numbers(content, channel.topic))
    return _columns(rows, path)


def _messages(reader: ModuleType, stream: IO[bytes], path: pathlib.Path,
              topics: Sequence[str] | None) -> Iterator[tuple[Any, Any, Any]]:
    """Schema, channel and message, of these topics."""
    recording = reader.make_reader(stream)
    summary = recording.get_summary()
    if summary and summary.channels and summary.schemas:  # what the index needs
        _require(topics, sorted({channel.topic for channel in summary.channels.values()}), path)
        yield from recording.iter_messages(topics=topics)
        return
    stream.seek(0)
    there = set()
    for schema, channel, message in reader.NonSeekingReader(stream).iter_messages(
            log_time_order=False):
        there.add(channel.topic)
        if topics is None or channel.topic in topics:
            yield schema, channel, message
    _require(topics, sorted(there), path)


def _require(topics: Sequence[str] | None, there: Sequence[str], path: pathlib.Path) -> None:
    for topic in topics or ():
        if topic not in there:
            raise InputError(f"{path}: expected a topic {topic!r}, found {listed(there)}")


def _decoder(schema: Any, channel: Any, path: pathlib.Path, factories: dict[str, Any],
             required: bool) -> Callable[[bytes], Any] | None:
    encoding = channel.message_encoding
    if encoding == "json":
        return json.loads
    if encoding not in SUPPORTS:
        if required:
            raise InputError(f"{path}, {channel.topic}: expected messages in JSON, protobuf or "
                             f"ROS 2 CDR, found {encoding!r}")
        return None
    if encoding not in factories:
        module = needed(SUPPORTS[encoding], f"reading {path}, {channel.topic},", "mcap")
        factories[encoding] = module.DecoderFactory()
    return factories[encoding].decoder_for(encoding, schema)


def _time(content: Any, message: Any, clock: str, place: str) -> int:
    """[ns]."""
    if clock != "header":
        return message.log_time if clock == "log" else message.publish_time
    stamp = _field(_field(content, "header"), "stamp")
    seconds = [_field(stamp, name) for name in ("sec", "secs", "seconds")]
    parts = [_field(stamp, name) for name in ("nanosec", "nsec", "nsecs", "nanos")]
    known = [next((n for n in numbers if n is not None), None) for numbers in (seconds, parts)]
    if None in known:
        raise InputError(f"{place}: clock: expected messages with header.stamp, found one without")
    return int(known[0]) * 10**9 + int(known[1])


def _field(content: Any, name: str) -> Any:
    return content.get(name) if isinstance(content, Mapping) else getattr(content, name, None)


def numbers(content: Any, name: str) -> Iterator[tuple[str, float]]:
    """Names of the numbers of a message, "/topic.field[0]", and the numbers."""
    if isinstance(content, (bool, int, float)):
        yield name, float(content)
    elif _is_list(content):
        for k, item in enumerate(content if len(content) <= LONGEST else ()):
            yield from numbers(item, f"{name}[{k}]")
    else:
        fields = dict(_fields(content))
        labels = _labels(fields)
        for field, value in fields.items():
            if labels and field != "name" and _is_list(value) and len(value) == len(labels):
                for label, item in zip(labels, value):
                    yield from numbers(item, f"{name}.{field}.{label}")
            else:
                yield from numbers(value, f"{name}.{field}")


def _fields(content: Any) -> Iterator[tuple[str, Any]]:
    """Of JSON, protobuf or ROS 2."""
    if isinstance(content, Mapping):
        yield from content.items()
    elif hasattr(content, "DESCRIPTOR"):
        for field in content.DESCRIPTOR.fields:
            yield field.name, getattr(content, field.name)
    else:
        for field in getattr(content, "__slots__", ()):
            yield field, getattr(content, field)


def _labels(fields: Mapping[str, Any]) -> list[str]:
    """The list `name` of texts, as of a JointState, whose order may change."""
    labels = fields.get("name")
    named = _is_list(labels) and len(labels) > 0 and all(isinstance(n, str) for n in labels)
    return list(labels) if named and len(set(labels)) == len(labels) else []


def _is_list(value: Any) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, (str, bytes, bytearray, Mapping))


def _columns(rows: Mapping[int, Mapping[str, float]], path: pathlib.Path) -> Columns:
    names = list(dict.fromkeys(name for row in rows.values() for name in row))
    if not names:
        raise InputError(f"{path}: expected messages with numbers in JSON, protobuf or ROS 2 CDR, "
                         "found none")
    times = sorted(rows)
    columns = {"time": numpy.array([(time - times[0]) * 1e-9 for time in times])}
    for name in names:
        columns[name] = numpy.array([rows[time].get(name, numpy.nan) for time in times])
    return columns
