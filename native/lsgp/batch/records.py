# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of an asset once it has ended: a record, which is a line of the journal."""

from __future__ import annotations

from typing import Any

from ..report import Report

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
    "cones": None,
    "islands": None,
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
    warnings = {warning["code"]: len(warning["elements"]["indices"]) for warning in report["warnings"]}
    figures = {key: report[key] for key in _FROM_REPORT}
    return EMPTY | figures | {"warnings": warnings, "cones": len(report["cones"])}


def ending(status: str, code: str, message: str, **known: Any) -> Record:
    """The record of an asset without a result.

    status: "refused" is the asset's fault: it ends so every time; "failed" may end otherwise another time.
    """
    return EMPTY | known | {"status": status, "code": code, "message": message}
