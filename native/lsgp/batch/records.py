# SPDX-License-Identifier: GPL-3.0-or-later
"""The outcome of an asset as a record, which is a line of the journal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

from ..run.report import Report

Record = dict[str, Any]

OK, REFUSED, FAILED = "ok", "refused", "failed"

# Every record has all of these keys, in this order; what does not apply is null or empty.
EMPTY: Record = {
    "asset": None,
    "status": OK,
    "code": None,
    "message": None,
    "output": None,
    "picture": None,
    "warnings": {},
    "triangles": None,
    "missing_faces": None,
    "missing_area_percent": None,
    "cones": None,
    "islands": None,
    "coverage": None,
    "distortion": None,
    "flipped": None,
    "wrong_angle_sums": None,
    "overlapping": None,
    "overlap_area": None,
    "input_bytes": None,
    "seconds": None,
    "cpu_seconds": None,
    "peak_memory_mb": None,
    "worker": None,
    "options": None,
}

_FROM_REPORT = ("triangles", "islands", "distortion", "flipped", "wrong_angle_sums", "overlapping", "overlap_area")


def record_of(report: Report) -> Record:
    """The figures of a result's report; of its cones their number, of a warning how many elements it names."""
    warnings: Counter[str] = Counter()
    for warning in report["warnings"]:
        warnings[warning["code"]] += len(warning["elements"]["indices"])
    figures = {key: report[key] for key in _FROM_REPORT}
    missing = report["missing"] or {"faces": [], "area_percent": 0.0}
    figures |= missing_columns(len(missing["faces"]), missing["area_percent"])
    figures["coverage"] = None if report["packing"] is None else report["packing"]["coverage"]
    return EMPTY | figures | {"warnings": dict(warnings), "cones": len(report["cones"])}


def missing_columns(faces: int, area_percent: float) -> Record:
    """Of faces that could have coordinates and have none: how many, and their part of the area."""
    return {"missing_faces": faces, "missing_area_percent": area_percent}


def is_whole(record: Record) -> bool:
    """Whether there is a result, with coordinates at all faces that can have some."""
    return record["status"] == OK and not record["missing_faces"]


def is_record(value: Any) -> bool:
    """Whether it is a valid record: all keys are present, and those that are read have the right types."""
    if not (isinstance(value, dict) and value.keys() >= EMPTY.keys()):
        return False
    has_result = value["status"] == OK
    always = {key: accepts for accepts, keys in _ALWAYS for key in keys}
    expected = always | (_OF_RESULTS if has_result else _OF_OTHERS)
    return value["status"] in (OK, REFUSED, FAILED) and all(accepts(value[key]) for key, accepts in expected.items())


def _is_text(value: Any) -> bool:
    """Text, also of a file name in any encoding."""
    if not isinstance(value, str):
        return False
    try:
        value.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        return False
    return True


def _is_figure(value: Any) -> bool:
    """A number that is finite."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300


def _or_null(accepts: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: value is None or accepts(value)


def _is_distortion(value: Any) -> bool:
    return isinstance(value, dict) and "l2_stretch" in value and all(map(_or_null(_is_figure), value.values()))


def _is_counts(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_figure, value.values()))


_MISSING = ("missing_faces", "missing_area_percent")
_ALWAYS = (
    (_is_text, ("asset", "options")),
    (_or_null(_is_figure), ("islands", "coverage", "seconds", "cpu_seconds", "peak_memory_mb", *_MISSING)),
    (_or_null(_is_distortion), ("distortion",)),
)
_OF_RESULTS = {
    "output": _is_text,
    "picture": _or_null(_is_text),
    "warnings": _is_counts,
    "triangles": _is_figure,
    "cones": _is_figure,
    "distortion": _is_distortion,
}
_OF_OTHERS = {"code": _is_text, "message": _is_text}


def ending(status: str, code: str, message: str, **known: Any) -> Record:
    """The record of an asset without a result.

    status: "refused" is due to the asset and final; "failed" may succeed in another run.
    """
    return EMPTY | known | {"status": status, "code": code, "message": message}
