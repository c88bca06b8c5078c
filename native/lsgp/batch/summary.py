# SPDX-License-Identifier: GPL-3.0-or-later
"""The summary of a run as a table."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Sequence

from ..base.counted import counted
from ..io.standard_streams import visible
from .progress import duration
from .records import FAILED, OK, REFUSED, Record, is_whole


def summary_table(records: Sequence[Record]) -> str:
    """Counts by outcome, and the figures of the results, as lines of text."""
    results = [record for record in records if record["status"] == OK]
    rows = [("results", len(results), "")]
    warned = Counter(code for record in results for code in record["warnings"])
    rows += [(f"  with {code}", count, "") for code, count in sorted(warned.items())]
    rows += _incomplete(results)
    for status in (REFUSED, FAILED):
        ended = [record for record in records if record["status"] == status]
        rows.append((status, len(ended), ""))
        for code, count in sorted(Counter(record["code"] for record in ended).items()):
            first = min(record["asset"] for record in ended if record["code"] == code)
            rows.append((f"  {code}", count, f"{first}{', ...' if count > 1 else ''}"))
    rows += _figures(records, results)
    lines = [counted(len(records), "asset")]
    lines += [f"{label:<28}{value:>12}  {visible(note)}".rstrip() for label, value, note in rows]
    return "\n".join([*lines, *_by_folder(records)])


def _by_folder(records: Sequence[Record]) -> list[str]:
    """A line of medians and highest values for each folder beside the others; none where there is only one."""
    folders: dict[str, list[Record]] = {}
    for record in sorted(records, key=lambda record: record["asset"]):
        folder, is_inside, _ = record["asset"].partition("/")
        folders.setdefault(folder if is_inside else ".", []).append(record)
    if len(folders) < 2:
        return []
    columns = ("assets", "results", "seconds", "highest", "islands", "highest", "square", "L2", "highest")
    lines = ["", f"{'folder, medians':<28}{''.join(f'{column:>10}' for column in columns)}"]
    for folder, inside in folders.items():
        results = [record for record in inside if record["status"] == OK]
        figures = [
            *_median_and_highest(inside, ".3g", lambda record: record["seconds"]),
            *_median_and_highest(results, "g", lambda record: record["islands"]),
            *_median_and_highest(results, ".2f", lambda record: record["coverage"])[:1],
            *_median_and_highest(results, ".3f", lambda record: record["distortion"]["l2_stretch"]),
        ]
        lines.append(f"{visible(folder):<28}{''.join(f'{text:>10}' for text in (len(inside), len(results), *figures))}")
    return lines


def _median_and_highest(records: Sequence[Record], form: str, figure) -> tuple[str, str]:
    values = [value for value in map(figure, records) if value is not None]
    return (format(statistics.median(values), form), format(max(values), form)) if values else ("-", "-")


def _incomplete(results: Sequence[Record]) -> list[tuple[str, int, str]]:
    """Results that leave out faces, and the one that leaves out most of its area."""
    incomplete = [record for record in results if not is_whole(record)]
    if not incomplete:
        return []
    percent, name = max((record["missing_area_percent"] or 0.0, record["asset"]) for record in incomplete)
    return [("  with faces left out", len(incomplete), f"most {percent:.3g} % of the area: {name}")]


def _figures(records: Sequence[Record], results: Sequence[Record]) -> list[tuple[str, str | int, str]]:
    rows: list[tuple[str, str | int, str]] = []
    if results:
        rows.append(("triangles unwrapped", f"{sum(record['triangles'] for record in results):,}", ""))
        rows.append(_spread(results, "L2 stretch", ".4f", lambda record: record["distortion"]["l2_stretch"]))
    timed = [record for record in records if record["cpu_seconds"]]
    if timed:
        cpu = sum(record["cpu_seconds"] for record in timed)
        rows.append(("CPU time", duration(cpu), f"{3600 * len(timed) / cpu:,.0f} assets per core-hour"))
        rows.append(_spread(timed, "seconds an asset", ".3g", lambda record: record["seconds"]))
    measured = [record for record in records if record["peak_memory_mb"] is not None]
    if measured:
        rows.append(_spread(measured, "memory in MB", ".0f", lambda record: record["peak_memory_mb"]))
    return rows


def _spread(records: Sequence[Record], label: str, form: str, figure) -> tuple[str, str, str]:
    """The median of a figure, and the asset with the highest value; null, which stands for infinity, is left out."""
    values = [(figure(record), record["asset"]) for record in records if figure(record) is not None]
    if not values:
        return label, "-", ""
    highest, name = max(values)
    return (
        f"{label}, median",
        format(statistics.median(value for value, _ in values), form),
        (f"highest {highest:{form}}: {name}"),
    )
