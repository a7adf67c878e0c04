"""The planners that can be named, and the parameters that each of them takes.

The bindings' `params()` raises TypeError, so the setters that exist are listed here, under OMPL's
own parameter names. Planners of our own, and OMPL itself, are imported only when one is allocated.
"""

from __future__ import annotations

import difflib
import importlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.numbers_shown import shown
from planners.parameter_ranges import check_ranges

from .installed import installed_planners

if TYPE_CHECKING:
    from ompl import base as ob


RANGE_FRACTION = 0.025
"""Default range of a bound planner, in units of the space's extent."""


@dataclass(frozen=True)
class Parameter:
    """One parameter of a bound planner: the setter that takes it, and the type it wants."""

    setter: str
    kind: type


@dataclass(frozen=True)
class BoundPlanner:
    """A planner of OMPL's.

    Attributes:
        name: its class in ``ompl.geometric``.
        parameters: by OMPL's parameter names.
        second_thread: it runs a second thread. Then a Python objective, a Python goal region or
            a termination condition made from a Python function deadlocks, and an exception in
            a callback aborts the process; Python checkers, motion validators and samplers with
            C++ objectives and conditions are fine.
        needs_plugin: it works with our own checker only.
        informed: it draws from where better paths can run, which OMPL knows of rigid robots'
            spaces only.
        informed_by: parameters that make it do so.
    """

    name: str
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    second_thread: bool = False
    needs_plugin: bool = False
    informed: bool = False
    informed_by: tuple[str, ...] = ()

    def check_articulated(self, values: Mapping[str, Any]) -> None:
        """Check that the planner works for articulated robots with these parameters.

        Raises:
            PlannerError: it does not.
        """
        why = "OMPL draws informed samples in the spaces of rigid robots only"
        if self.informed:
            raise PlannerError(f"{self.name} does not plan for articulated robots: {why}")
        for name in self.informed_by:
            if values.get(name):
                raise PlannerError(f"{self.name}.{name}: not for articulated robots: {why}")

    def parameter_kinds(self) -> dict[str, Any]:
        """The type of every parameter."""
        return {name: parameter.kind for name, parameter in self.parameters.items()}

    def allocate(self, si: ob.SpaceInformation, values: Mapping[str, Any]) -> ob.Planner:
        """A new planner with ``values`` set; they must have gone through `checked_parameters`."""
        from .bindings import allocate_bound_planner

        planner = allocate_bound_planner(self.name, si)
        if "range" in self.parameters and "range" not in values:
            planner.setRange(default_range(si))
        # In the table's order: BITstar samples just in time only after k-nearest is off.
        for name in (name for name in self.parameters if name in values):
            _set(self.name, name, values[name], getattr(planner, self.parameters[name].setter))
        self._check_taken(planner, values)
        return planner

    def _check_taken(self, planner: ob.Planner, values: Mapping[str, Any]) -> None:
        if values.get("ordered_sampling") and not (
            planner.getInformedSampling() or planner.getSampleRejection()
        ):  # it orders the samples of either, and without them solving ends the process
            raise PlannerError(
                f"{self.name}.ordered_sampling: needs informed_sampling or sample_rejection"
            )
        # OMPL refuses some combinations with a line in its log and nothing else.
        for name, value in values.items():
            getter = getattr(planner, "get" + self.parameters[name].setter.removeprefix("set"))
            if getter() != value:
                raise PlannerError(
                    f"{self.name}.{name}: {value!r} is not taken, it stays at {getter()!r};"
                    " it does not go together with other parameters"
                )


@dataclass(frozen=True)
class OwnPlanner:
    """A planner of ours, a subclass of `ob.Planner` with these members.

    ``PARAMETERS`` maps the names of its parameters, which are plain attributes, to their types;
    without it there are none. ``RIGID_ONLY``, if it is there and true, says that it plans for rigid
    robots only. Optional are also the method ``check_parameters()``, which raises
    PlannerError, the method ``warm_up()``, which compiles what a solve needs, the mapping
    ``statistics``, whose entries ``build_time`` and ``search_time`` go to a result's times,
    ``error``, the traceback of an exception that ended the last solve with CRASH, and the methods
    ``load_roadmap(path)`` and ``save_roadmap(path)``, which go together.

    Attributes:
        name: the class.
        module: where it lives; imported on first use.
    """

    name: str
    module: str
    second_thread: bool = False
    needs_plugin: bool = True

    def load(self) -> Any:
        """The class itself."""
        return getattr(importlib.import_module(self.module), self.name)

    def check_articulated(self, values: Mapping[str, Any]) -> None:  # noqa: ARG002
        """Check that the planner works for articulated robots.

        Raises:
            PlannerError: it does not.
        """
        if getattr(self.load(), "RIGID_ONLY", False):
            raise PlannerError(f"{self.name} plans for rigid robots only, not for articulated ones")

    def parameter_kinds(self) -> dict[str, Any]:
        """The type (or tuple of types) of every parameter."""
        return dict(getattr(self.load(), "PARAMETERS", {}))

    def check_values(self, values: Mapping[str, Any]) -> None:
        """Let the class check values of its parameters, if it has a ``check_values``.

        Raises:
            PlannerError: a value is out of its range.
        """
        if hasattr(self.load(), "check_values"):
            self.load().check_values(values)

    def allocate(self, si: ob.SpaceInformation, values: Mapping[str, Any]) -> ob.Planner:
        """A new planner with ``values`` set; they must have gone through `checked_parameters`."""
        planner = self._constructed(si)
        for name, value in values.items():
            setattr(planner, name, value)
        if hasattr(planner, "check_parameters"):
            planner.check_parameters()
        return planner

    def _constructed(self, si: ob.SpaceInformation) -> Any:
        try:
            return self.load()(si)
        except PlannerError:
            raise
        except Exception as error:
            reason = (str(error).strip().splitlines() or ["no reason given"])[0]
            raise PlannerError(
                f"planner {self.module}:{self.name}: expected a class that is constructed from a"
                f" SpaceInformation alone, got {type(error).__name__}: {reason}"
            ) from error


PlannerEntry = BoundPlanner | OwnPlanner


def default_range(si: ob.SpaceInformation) -> float:
    """The longest motion that a tree planner should try, in the metric of the space of ``si``.

    OMPL's own choice, a fifth of the space's extent, suits wide spaces only: among obstacles such
    motions are seldom free, and a tree that takes shorter ones grows sooner.
    """
    return RANGE_FRACTION * float(si.getMaximumExtent())


def _table(kind: type, **setters: str) -> dict[str, Parameter]:
    return {name: Parameter(setter, kind) for name, setter in setters.items()}


_RANGE = _table(float, range="setRange")
_BIAS = _table(float, goal_bias="setGoalBias")
_INTERMEDIATE = _table(bool, intermediate_states="setIntermediateStates")
_CELLS = _table(
    float, border_fraction="setBorderFraction", min_valid_path_fraction="setMinValidPathFraction"
)
_CELL_FAILURE = _table(float, failed_expansion_score_factor="setFailedExpansionCellScoreFactor")
_NEIGHBOURS = _table(int, max_nearest_neighbors="setMaxNearestNeighbors")
_RRT_STAR = {
    **_RANGE,
    **_BIAS,
    **_table(float, rewire_factor="setRewireFactor", prune_threshold="setPruneThreshold"),
    **_table(
        int, ordering_batch_size="setBatchSize", number_sampling_attempts="setNumSamplingAttempts"
    ),
    **_table(
        bool,
        use_k_nearest="setKNearest",
        delay_collision_checking="setDelayCC",
        tree_pruning="setTreePruning",
        pruned_measure="setPrunedMeasure",
        informed_sampling="setInformedSampling",
        sample_rejection="setSampleRejection",
        new_state_rejection="setNewStateRejection",
        use_admissible_heuristic="setAdmissibleCostToCome",
        ordered_sampling="setOrderedSampling",
        focus_search="setFocusSearch",
    ),
}
_INFORMED = ("informed_sampling", "ordered_sampling", "focus_search")
_BIT_STAR = {
    **_table(
        float,
        rewire_factor="setRewireFactor",
        prune_threshold_as_fractional_cost_change="setPruneThresholdFraction",
    ),
    **_table(int, samples_per_batch="setSamplesPerBatch"),
    **_table(
        bool,
        use_k_nearest="setUseKNearest",
        use_graph_pruning="setPruning",
        use_just_in_time_sampling="setJustInTimeSampling",
        drop_unconnected_samples_on_prune="setDropSamplesOnPrune",
        stop_on_each_solution_improvement="setStopOnSolnImprovement",
        find_approximate_solutions="setConsiderApproximateSolutions",
    ),
}
_FMT = {
    **_table(int, num_samples="setNumSamples"),
    **_table(
        float, radius_multiplier="setRadiusMultiplier", free_space_volume="setFreeSpaceVolume"
    ),
    **_table(
        bool,
        use_k_nearest="setNearestK",
        cache_cc="setCacheCC",
        heuristics="setHeuristics",
        extended_fmt="setExtendedFMT",
    ),
}

_ENTRIES: tuple[PlannerEntry, ...] = (
    OwnPlanner("HighwayRoadmap", "planners.highway"),
    OwnPlanner("FreeIntervalRRTConnect", "planners.free_interval_rrt_connect"),
    BoundPlanner("AORRTC", _RANGE, informed=True),
    BoundPlanner("BFMT", _FMT),
    BoundPlanner("BITstar", _BIT_STAR, informed=True),
    BoundPlanner("BKPIECE1", {**_RANGE, **_CELLS, **_CELL_FAILURE}),
    BoundPlanner("FMT", _FMT),
    BoundPlanner("InformedRRTstar", _RRT_STAR, informed=True),
    BoundPlanner("KPIECE1", {**_RANGE, **_BIAS, **_CELLS, **_CELL_FAILURE}),
    BoundPlanner("LBKPIECE1", {**_RANGE, **_CELLS}),
    BoundPlanner("PRM", _NEIGHBOURS, second_thread=True),
    BoundPlanner("PRMstar", second_thread=True),
    BoundPlanner("RRT", {**_RANGE, **_BIAS, **_INTERMEDIATE}),
    BoundPlanner("RRTConnect", {**_RANGE, **_INTERMEDIATE}),
    BoundPlanner("RRTstar", _RRT_STAR, informed_by=_INFORMED),
    BoundPlanner("SORRTstar", _RRT_STAR, informed=True),
)
_BY_NAME = {entry.name: entry for entry in _ENTRIES}


def planner_names() -> tuple[str, ...]:
    """The names of all planners: our own, OMPL's, then those of other installed packages."""
    return (*_BY_NAME, *(name for name in installed_planners() if name not in _BY_NAME))


def registered_planner(name: str) -> PlannerEntry:
    """The entry of a planner that is built in or installed; what data may name.

    Files can come from anybody, so that a name in one must never choose code: ``module:Class``
    is refused here.

    Raises:
        PlannerError: no planner has this name; the message suggests the closest ones.
    """
    if name in _BY_NAME:
        return _BY_NAME[name]
    if ":" in name:
        raise PlannerError(
            f"planner {name!r}: expected a planner's name; files cannot name classes, since"
            " opening a file must not run code. If you trust it, name it yourself: --planner"
            f" {name}, or planner={name!r} in Python"
        )
    installed = installed_planners()
    if name in installed:
        return _foreign_planner(*installed[name].split(":", 1))
    raise PlannerError(f"unknown planner {name!r}{_hint(name, planner_names())}")


def find_planner(name: str) -> PlannerEntry:
    """The entry of a planner that the user names; for names in files, see `registered_planner`.

    A name ``module:Class`` stands for a subclass of `ob.Planner` of your own in a module that
    can be imported, see `OwnPlanner`; with a class attribute ``NEEDS_PLUGIN`` that is true it
    works with the plug-in's checker only.

    Raises:
        PlannerError: no planner has this name (the message suggests the closest ones), the class
            cannot be imported, or it is no planner.
    """
    return _foreign_planner(*name.split(":", 1)) if ":" in name else registered_planner(name)


def _foreign_planner(module: str, class_name: str) -> OwnPlanner:
    where = f"planner {module}:{class_name}"
    entry = OwnPlanner(class_name, module)
    try:
        found = entry.load()
    except AttributeError as error:
        if getattr(error, "name", None) != class_name:
            raise _broken_module(where, error) from error
        raise PlannerError(f"{where}: the module {module} has no {class_name}") from None
    except (Exception, SystemExit) as error:
        raise _broken_module(where, error) from error
    from ompl import base as ob

    if not isinstance(found, type) or not issubclass(found, ob.Planner):
        kind = f"the class {found.__name__}" if isinstance(found, type) else type(found).__name__
        raise PlannerError(
            f"{where}: expected a class derived from ompl.base.Planner, this is {kind}; name the"
            " class of your planner"
        )
    return replace(entry, needs_plugin=bool(getattr(found, "NEEDS_PLUGIN", False)))


def _broken_module(where: str, error: BaseException) -> PlannerError:
    reason = " ".join(str(error).split())
    if isinstance(error, (ImportError, ValueError)):  # an empty name is a ValueError
        return PlannerError(f"{where}: cannot import it: {reason}")
    return PlannerError(
        f"{where}: cannot import it: the module raised {type(error).__name__}: {reason}"
    )


def checked_parameters(entry: PlannerEntry, values: Mapping[str, Any]) -> dict[str, Any]:
    """``values`` with every name known to the planner and every value of its type.

    Raises:
        PlannerError: unknown parameter (the message suggests the closest), or a wrong type.
    """
    kinds = entry.parameter_kinds()
    for name in values:
        if name not in kinds:
            raise PlannerError(f"{entry.name} has no parameter {name!r}{_hint(name, kinds)}")
    converted = {
        name: _converted(f"{entry.name}.{name}", value, kinds[name])
        for name, value in values.items()
    }
    if isinstance(entry, OwnPlanner):
        entry.check_values(converted)
    else:
        check_ranges(entry.name, converted)
    return converted


def _converted(where: str, value: Any, kind: Any) -> Any:
    kinds = kind if isinstance(kind, tuple) else (kind,)
    if type(value) not in (int, float):
        if type(value) in kinds:
            return value
    elif _is_finite(value):
        if int in kinds and float(value).is_integer():
            return int(value)
        if float in kinds:
            return float(value)
    expected = " or ".join("None" if k is type(None) else k.__name__ for k in kinds)
    raise PlannerError(f"{where}: expected {expected}, got {shown(value)}")


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer that no double holds
        return False


def _set(planner: str, name: str, value: Any, setter: Any) -> None:
    try:
        setter(value)
    except PlannerError:
        raise
    except (TypeError, ValueError, RuntimeError, OverflowError) as error:
        reason = str(error).splitlines()[0]
        raise PlannerError(f"{planner}.{name}: {value!r} is refused: {reason}") from error


def _hint(name: str, known: Iterable[str]) -> str:
    names = list(known)
    lowered = {known_name.lower(): known_name for known_name in names}
    close = difflib.get_close_matches(name.lower(), lowered, n=3, cutoff=0.5)
    if close:
        return "; did you mean " + " or ".join(lowered[match] for match in close) + "?"
    return f"; known: {', '.join(names)}" if names else "; it takes none"
