# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of a session with the library, and the steps that change it, or call a verb and check its result."""

from __future__ import annotations

import hashlib
import pickle
import threading
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any

import lsgp
import numpy as np
import zoo
from meshes import edges_of
from numpy.typing import NDArray
from opened_surface import named_by
from outcome_check import (
    cuts_faults,
    error_faults,
    gains_faults,
    measurement_faults,
    placement_faults,
    prescription_faults,
    result_faults,
    same_measures,
    warning_faults,
)
from result_check import undeclared_faults

from . import places
from .command import command_faults
from .steps import Step

SAME_ANGLES = 1e-9  # radians: prescribing and unwrapping choose alike
# Of these a result has the time it took and the work, which differ where something is kept from the call before.
NOT_COMPARED = {"stage_seconds", "factorizations", "back_substitutions"}
# With cones that were placed, there are cones enough and their angles add up.
NEVER_OF_PLACED = {
    "TOO_FEW_CONES",
    "GAUSS_BONNET",
    "CONE_ANGLE_RANGE",
    "CONE_DUPLICATE",
    "CONE_INDEX",
    "CONE_NOT_ON_SURFACE",
}


@dataclass
class Outcome:
    """A call that has ended: with a value, or with an error."""

    value: Any = None
    error: BaseException | None = None

    @property
    def told(self) -> str:
        return (
            type(self.value).__name__ if self.error is None else getattr(self.error, "code", type(self.error).__name__)
        )

    def fingerprint(self) -> tuple[str, ...]:
        if self.error is None:
            return ("value", digest(self.value))
        elements = getattr(self.error, "elements", lsgp.Elements())
        return ("error", type(self.error).__name__, self.told, elements.kind, repr(elements.indices.tolist()))


def outcome(call: Callable[[], Any]) -> Outcome:
    try:
        return Outcome(call())
    except Exception as error:
        return Outcome(error=error)


def digest(value: Any) -> str:
    """Of all that an answer holds, to the last bit."""
    hasher = hashlib.sha256()

    def add(part: Any) -> None:
        if isinstance(part, np.ndarray):
            hasher.update(part.tobytes())
        elif hasattr(part, "__dataclass_fields__"):
            for one in fields(part):
                if one.name not in NOT_COMPARED:
                    add(getattr(part, one.name))
        elif isinstance(part, list | tuple):
            for one in part:
                add(one)
        else:
            hasher.update(repr(part).encode())

    add(value)
    return hasher.hexdigest()


class Interruption(Exception):
    """What a progress callback of ours raises."""


@dataclass
class World:
    """A surface with all that is chosen for it, and what the last calls left."""

    member: zoo.Member = field(default_factory=lambda: zoo.member("box-cells=1-size=1x1x1"))

    def __post_init__(self) -> None:
        self._enter(self.member)

    def _enter(self, member: zoo.Member) -> None:
        self.member, mesh = member, member.mesh()
        self.own_cones = mesh.cones.tolist()
        self.surface = lsgp.Surface(mesh.positions, mesh.triangles, member.edges())
        self.cones: list[int] = self.own_cones
        self.angles: list[float | None] | None = None
        self.pins: lsgp.Pins | None = None
        self.options = lsgp.Options()
        self.result: lsgp.Result | None = None
        self.pressed = False  # by a preset
        self._renew_solver()

    def _renew_solver(self) -> None:
        self.solver = lsgp.Solver(self.surface)

    @property
    def _triangles(self) -> NDArray[np.int32]:
        return self.surface.triangles

    @property
    def _total(self) -> int:
        return len(self.surface.positions)

    def perform(self, step: Step) -> tuple[str, list[str]]:
        """How a step ended, in a word, and what is wrong with that."""
        return getattr(self, "_" + step["do"].replace(" ", "_"))(step)

    # --- what is chosen -----------------------------------------------------------------------------------------------

    def _take_mesh(self, step: Step) -> tuple[str, list[str]]:
        self._enter(zoo.member(step["mesh"]))
        return self.member.family, []

    def _change_surface(self, **changed: Any) -> tuple[str, list[str]]:
        self.surface = replace(self.surface, **changed)
        self._renew_solver()
        return "changed", []

    def _mark_seams(self, step: Step) -> tuple[str, list[str]]:
        return self._change_surface(
            seams=places.seams_of_kind(step["kind"], step["seed"], step["count"], self._triangles, self._total)
        )

    def _end_at_borders(self, step: Step) -> tuple[str, list[str]]:
        if step["kind"] != "creases":
            return self._change_surface(
                borders=places.seams_of_kind(step["kind"], step["seed"], step["count"], self._triangles, self._total)
            )
        found = outcome(lambda: lsgp.crease_borders(self.surface, self.cones))
        if found.error is None:
            self._change_surface(borders=found.value)
        return found.told, []

    def _mark_features(self, step: Step) -> tuple[str, list[str]]:
        if step["kind"] == "creases":
            found = outcome(lambda: lsgp.feature_edges(self.surface, angle=0.5, borders=True))
            if found.error is None:
                self._change_surface(features=found.value)
            return found.told, []
        return self._change_surface(
            features=places.seams_of_kind(step["kind"], step["seed"], step["count"], self._triangles, self._total)
        )

    def _weigh(self, step: Step) -> tuple[str, list[str]]:
        return self._change_surface(importance=places.importance_of_kind(step["kind"], step["seed"], self._total))

    def _direct(self, step: Step) -> tuple[str, list[str]]:
        directions = places.directions_of_kind(step["kind"], step["seed"], len(self._triangles))
        return self._change_surface(directions=directions)

    def _allow_cuts(self, step: Step) -> tuple[str, list[str]]:
        return self._change_surface(
            edges=places.edges_of_kind(step["kind"], step["seed"], self._triangles, self._total), cut_costs=None
        )

    def _cost_cuts(self, step: Step) -> tuple[str, list[str]]:
        edges = edges_of(self._triangles) if self.surface.edges is None else self.surface.edges
        if step["kind"] != "seen":
            costs = places.cut_costs_of_kind(step["kind"], step["seed"], len(edges))
            return self._change_surface(edges=edges, cut_costs=costs)
        front = np.random.default_rng(step["seed"]).normal(size=3)
        of = replace(self.surface, edges=edges, cut_costs=None)
        seen = outcome(lambda: lsgp.cut_costs(of, front))
        if seen.error is None:
            self._change_surface(edges=edges, cut_costs=seen.value)
        return seen.told, []

    def _choose_cones(self, step: Step) -> tuple[str, list[str]]:
        if step["kind"] == "placed":
            placed = outcome(lambda: lsgp.place_cones(self.surface, seams=self.options.seams))
            self._adopt(placed.value)
            return placed.told, []
        self.cones = places.cones_of_kind(
            step["kind"], step["seed"], step["count"], self.cones, self.own_cones, self._triangles, self._total
        )
        self.angles = None
        return "changed", []

    def _adopt(self, placed: lsgp.Placement | None) -> None:
        if placed is not None:
            self.cones, self.angles = placed.cones.tolist(), placed.cone_angles.tolist()

    def _choose_angles(self, step: Step) -> tuple[str, list[str]]:
        plain = lsgp.Options(seams=self.options.seams)
        found = outcome(lambda: lsgp.prescribe_curvature(self.surface, self.cones, None, plain))
        angles = None if found.error else found.value.cone_angles.tolist()
        self.angles = places.angles_of_kind(step["kind"], step["seed"], len(self.cones), angles)
        return "changed", []

    def _pin(self, step: Step) -> tuple[str, list[str]]:
        self.pins = places.pins_of_kind(
            step["kind"], step["seed"], step["count"], self.result, 3 * len(self._triangles)
        )
        return "changed", []

    def _choose_options(self, step: Step) -> tuple[str, list[str]]:
        base = lsgp.Options() if step["afresh"] else self.options
        changed = dict(step["options"])
        if "loop_turning" in changed:
            changed["loop_turning"] = places.turning_of_kind(
                changed["loop_turning"], step["seed"], self._triangles, self._total
            )
        if "seamless" in changed:
            seamless = changed["seamless"] == "asked for"
            changed["seamless"] = lsgp.Seamless(**step["seamless"]) if seamless else None
        self.options = replace(base, **changed)
        return "changed", []

    # --- the verbs ----------------------------------------------------------------------------------------------------

    def _fresh(self, progress: Any = None) -> lsgp.Result:
        return lsgp.parameterize(self.surface, self.cones, self.angles, self.options, self.pins, progress)

    def _again(self, progress: Any = None) -> lsgp.Result:
        return self.solver.parameterize(self.cones, self.angles, self.options, self.pins, progress)

    def _judged(self, ended: Outcome) -> list[str]:
        if ended.error is not None:
            return error_faults(self.surface, ended.error)
        self.result, self.pressed = ended.value, False
        given = None
        if self.options.method == "lsgp" and len(set(self.cones)) == len(self.cones):
            given = dict(zip(self.cones, self.angles or [None] * len(self.cones), strict=False))
        return result_faults(self.surface, ended.value, self.options, given, pinned=self.pins is not None)

    def _parameterize(self, step: Step) -> tuple[str, list[str]]:
        ended = outcome(self._fresh)
        return ended.told, self._judged(ended)

    def _solve(self, step: Step) -> tuple[str, list[str]]:
        fresh, again = outcome(self._fresh), outcome(self._again)
        faults = self._judged(fresh)
        if fresh.fingerprint() != again.fingerprint():
            faults.append(f"the Solver's answer is another: {again.told} for {fresh.told}{_gap(fresh, again)}")
        return fresh.told, faults

    def _verb(self, name: str) -> Callable[[Any], Any]:
        return {
            "parameterize": self._fresh,
            "solve": self._again,
            "place": lambda progress=None: lsgp.place_cones(self.surface, seams=self.options.seams, progress=progress),
            "gains": lambda progress=None: lsgp.cone_gains(
                self.surface, self.cones, self.angles, seams=self.options.seams, progress=progress
            ),
            "prescribe": lambda progress=None: lsgp.prescribe_curvature(
                self.surface, self.cones, self.angles, self.options, progress
            ),
            "cuts": lambda progress=None: lsgp.find_cuts(self.surface, self.cones, self.options, progress),
        }[name]

    def _cancel(self, step: Step) -> tuple[str, list[str]]:
        verb, calls = self._verb(step["verb"]), [0]

        def progress(done: float) -> bool:
            calls[0] += 1
            if calls[0] > step["call"] and step["how"] == "raise":
                raise Interruption
            return calls[0] <= step["call"]

        before, stopped, after = outcome(verb), outcome(lambda: verb(progress)), outcome(verb)
        faults = []
        if calls[0] > step["call"]:
            expected = Interruption if step["how"] == "raise" else lsgp.Cancelled
            if not isinstance(stopped.error, expected):
                faults.append(f"stopped with {stopped.told}, not {expected.__name__}")
            elif expected is lsgp.Cancelled:
                faults += error_faults(self.surface, stopped.error)
        elif stopped.fingerprint() != before.fingerprint():
            faults.append(f"{step['verb']}: with progress it is {stopped.told} and {before.told} without")
        if before.fingerprint() != after.fingerprint():
            faults.append(f"{step['verb']}: after it was stopped it is {after.told}, and {before.told} before")
        return stopped.told, faults

    def _place_cones(self, step: Step) -> tuple[str, list[str]]:
        how = dict(step["options"])
        if how.pop("mirror", "none") != "none":
            how["mirror"] = (self.surface.positions.mean(axis=0).tolist(), [1.0, 0.0, 0.0])
        ended = outcome(lambda: lsgp.place_cones(self.surface, self.cones, self.angles, **how))
        if ended.error is not None:
            return ended.told, error_faults(self.surface, ended.error)
        placed = ended.value
        faults = placement_faults(self.surface, placed, how.get("target", 1.05) if how.get("count") is None else None)
        options = lsgp.Options(seams=how.get("seams", "follow"))
        unwrapped = outcome(lambda: lsgp.parameterize(self.surface, placed.cones, placed.cone_angles, options))
        if unwrapped.error is None:
            faults += result_faults(self.surface, unwrapped.value, options)
        elif unwrapped.told in NEVER_OF_PLACED and not _share_an_angle(placed):
            faults.append(f"with the placed cones there is no map: {unwrapped.error}")
        if step["adopt"]:
            self._adopt(placed)
        return f"{ended.told}, {unwrapped.told}", faults

    def _auto_unwrap(self, step: Step) -> tuple[str, list[str]]:
        how, rng = dict(step["options"]), np.random.default_rng(step["seed"])
        if how.pop("up", "none") == "random":
            how["up"] = rng.normal(size=3).tolist()
        weights = how.pop("weights", "usual")
        if weights != "usual":
            values = [0.0, 0.1, 1.0] if weights == "random" else [0.0, 50.0, 1e6]
            how["weights"] = lsgp.Weights(*map(float, rng.choice(values, len(fields(lsgp.Weights)))))
        ended = outcome(lambda: lsgp.auto_unwrap(self.surface, **how))
        if ended.error is not None:
            return ended.told, error_faults(self.surface, ended.error)
        self.result, self.pressed = ended.value, True
        faults = warning_faults(self.surface, self.result.warnings)
        # Islands are moved, some of them apart from others with which they are joined by transitions.
        opened, plain = replace(self.surface, borders=self.result.borders), lsgp.Options(method="lscm")
        found = undeclared_faults(opened, self.result, plain, pressed=True)
        if how.get("stack"):  # islands lie on others, turned or mirrored as these are
            so = ("overlap", "directions", "flipped")
            found = [fault for fault in found if not any(word in fault for word in so)]
        return ended.told, faults + found

    def _shape_a_patch(self, step: Step) -> tuple[str, list[str]]:
        """What has coordinates keeps some, and what is pinned its own."""
        total = len(self._triangles)
        if self.result is None or len(self.result.corner_uv) != total:
            return "nothing to shape", []
        rng, uv = np.random.default_rng(step["seed"]), self.result.corner_uv
        some = np.flatnonzero(self.result.island == rng.integers(max(self.result.island.max(initial=0) + 1, 1)))
        some = some[: max(1, round(step["share"] * len(some)))]
        pinned = rng.permutation(3 * total)[: step["pins"]]
        ended = outcome(lambda: lsgp.shape_patches(self.surface, uv, some, step["shape"], pinned=pinned))
        if ended.error is not None:
            return ended.told, error_faults(self.surface, ended.error)
        shaped = ended.value.corner_uv
        faults = []
        if not np.array_equal(np.isfinite(shaped).all(axis=(1, 2)), np.isfinite(uv).all(axis=(1, 2))):
            faults.append("other triangles have coordinates than before")
        if not np.allclose(shaped.reshape(-1, 2)[pinned], uv.reshape(-1, 2)[pinned], rtol=0, atol=1e-9, equal_nan=True):
            faults.append("a pinned corner has moved")
        return ended.told, faults

    def _cone_gains(self, step: Step) -> tuple[str, list[str]]:
        ended = outcome(self._verb("gains"))
        return ended.told, (
            error_faults(self.surface, ended.error) if ended.error else gains_faults(self.surface, ended.value)
        )

    def _prescribe(self, step: Step) -> tuple[str, list[str]]:
        ended = outcome(self._verb("prescribe"))
        if ended.error is not None:
            return ended.told, error_faults(self.surface, ended.error)
        faults, told = prescription_faults(self.surface, ended.value), ended.value
        # Which angles suit strokes better is seen from maps.
        options = replace(self.options, follow_strokes=False)
        unwrapped = outcome(lambda: lsgp.parameterize(self.surface, self.cones, self.angles, options, self.pins))
        if unwrapped.error is None and self._keeps_angles(unwrapped.value):
            of_map = dict(zip(unwrapped.value.cones.tolist(), unwrapped.value.cone_angles.tolist(), strict=True))
            gaps = [
                abs(of_map.get(cone, angle) - angle)
                for cone, angle in zip(told.cones.tolist(), told.cone_angles, strict=True)
            ]
            if max(gaps, default=0) > SAME_ANGLES:
                faults.append(f"angles of the map are off those prescribed by {max(gaps):.1e}")
        return ended.told, faults

    def _keeps_angles(self, result: lsgp.Result) -> bool:
        """Whether the angles of a map are those prescribed: neither rounded nor changed for it to have no flips."""
        mended = result.repair.flipped_before or result.repair.wrong_angle_sums_before
        return self.options.seamless is None and not mended and not len(named_by(result, "ANGLES_ADJUSTED"))

    def _find_cuts(self, step: Step) -> tuple[str, list[str]]:
        ended = outcome(self._verb("cuts"))
        return ended.told, (
            error_faults(self.surface, ended.error) if ended.error else cuts_faults(self.surface, ended.value)
        )

    def _measure(self, step: Step) -> tuple[str, list[str]]:
        uv = places.coordinates_of_kind(step["kind"], step["seed"], self.result, len(self._triangles))
        cones = None if step["count"] % 2 else self.cones
        ended = outcome(lambda: lsgp.measure_distortion(self.surface, uv, cones))
        if ended.error is not None:
            return ended.told, error_faults(self.surface, ended.error)
        faults = measurement_faults(self.surface, ended.value, uv)
        if self.result is not None and uv is self.result.corner_uv:
            faults += same_measures(self.surface, self.result, ended.value, pressed=self.pressed)
        return ended.told, faults

    def _command(self, step: Step) -> tuple[str, list[str]]:
        return command_faults(self.surface, self.cones, self.angles, self.options, step)

    # --- what nobody should do ----------------------------------------------------------------------------------------

    def _enter_again(self, step: Step) -> tuple[str, list[str]]:
        """A Solver that is called from its own progress refuses, and the outer call goes on."""
        inner: list[Outcome] = []

        def progress(done: float) -> bool:
            if not inner:
                inner.append(outcome(self._again))
            return True

        before, outer, after = outcome(self._fresh), outcome(lambda: self._again(progress)), outcome(self._again)
        faults = error_faults(None, inner[0].error) if inner and inner[0].error else []
        if inner and inner[0].error is None:
            faults.append("a Solver may be entered again from its own progress")
        for name, ended in (("outer", outer), ("next", after)):
            if ended.fingerprint() != before.fingerprint():
                faults.append(f"the {name} call is {ended.told} where a fresh one is {before.told}")
        return outer.told, faults

    def _two_threads(self, step: Step) -> tuple[str, list[str]]:
        """Fresh calls at the same time are as alone; those of one Solver are right or refused."""
        expected, ended = outcome(self._fresh), [Outcome() for _ in range(4)]
        calls = [self._fresh, self._fresh, self._again, self._again]

        def run(i: int) -> None:
            ended[i] = outcome(calls[i])

        threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        faults = []
        for i, one in enumerate(ended):
            busy = i >= 2 and isinstance(one.error, lsgp.LsgpError)
            if one.fingerprint() != expected.fingerprint() and not busy:
                faults.append(f"in a thread it is {one.told} where alone it is {expected.told}{_gap(expected, one)}")
        return expected.told, faults

    def _pickle(self, step: Step) -> tuple[str, list[str]]:
        """Whatever is passed or comes back goes to other processes."""
        ended = outcome(self._fresh)
        faults = []
        for what in (self.surface, self.options, self.pins, ended.value, ended.error):
            again = outcome(lambda what=what: pickle.loads(pickle.dumps(what)))
            same = Outcome(error=what) if isinstance(what, BaseException) else Outcome(what)
            other = Outcome(error=again.value) if isinstance(again.value, BaseException) else again
            if same.fingerprint() != other.fingerprint():
                faults.append(f"{type(what).__name__} does not come out of a pickle as it was: {again.error}")
        return ended.told, faults


def _share_an_angle(placed: lsgp.Placement) -> bool:
    """Whether cones of different angles are one vertex, so that the angles cannot be what they should."""
    return any(finding.code == "SPLIT_VERTEX" and "separate angle" in finding.message for finding in placed.warnings)


def _gap(one: Outcome, other: Outcome) -> str:
    """By how much two maps differ."""
    if not isinstance(one.value, lsgp.Result) or not isinstance(other.value, lsgp.Result):
        return ""
    gap = np.abs(one.value.corner_uv - other.value.corner_uv)
    different = [
        f.name
        for f in fields(one.value)
        if f.name not in NOT_COMPARED and digest(getattr(one.value, f.name)) != digest(getattr(other.value, f.name))
    ]
    return f", coordinates by {np.nanmax(gap, initial=0):.1e}, in {', '.join(different)}"
