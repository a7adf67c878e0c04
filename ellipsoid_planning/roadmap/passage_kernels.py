"""Compiling the kernels that look for passages, in a process of their own if there are none yet.

They share little with those of the search, so that a machine's first run, which compiles both,
takes little more than half as long on two cores. The cache on disk brings them together.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import (
    centring,
    contact_model,
    linear,
    motion,
    passages,
    validity,
)
from ellipsoid_planning.kernels.compile import CACHE_FOLDER, compiling_elsewhere
from ellipsoid_planning.kernels.roadmap_metric import turn_length
from ellipsoid_planning.kernels.robot_model import poses_are_free, step_count
from ellipsoid_planning.processes import end_with
from ellipsoid_planning.roadmap.gates import GateFinder, probe
from ellipsoid_planning.roadmap.joint_layers import home_configuration, layer_metric
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link, RigidRobot
from ellipsoid_planning.world import World

# Stands in the cache's folder while and after somebody compiles these kernels.
_MARKS = {False: "passages", True: "passages-articulated"}
_PROGRAM = "from ellipsoid_planning.roadmap.passage_kernels import main; main({}, {})"
# No compilation takes as long [s].
_LONGEST = 600.0


def compile_passage_kernels(cspace: CSpace) -> None:
    """Call everything that looking for passages calls, without finding any."""
    model = cspace.model
    workspace = centring.new_workspace(model)
    home = np.zeros(cspace.robot.configuration_size)
    if isinstance(cspace, ArticulatedCSpace):
        home = home_configuration(cspace.articulated)
    elif cspace.dimension == 3 and cspace.rotates:
        home[6] = 1.0
    pose = cspace.poses(home)
    step, progress = np.zeros(step_count(model)), np.zeros(passages.PROGRESS)
    progress[passages.STATE] = passages.BLOCKED
    passages.follow(
        model,
        progress,
        step,
        cspace.rotates,
        1.0,
        1.0,
        1.0,
        pose,
        1,
        1,
        workspace,
        motion.motion_workspaces(),
    )
    contact_model.samples_along(model, pose[0], step, 1.0, np.empty_like(pose))
    contact_model.difference(model, pose[0], pose[0], 1.0, step)
    contact_model.moved(model, pose[0], step, 1.0, pose[0])
    linear.rotation_matrix(0.0, 0.0, 0.0, 1.0)
    poses_are_free(model, pose, np.empty(1, dtype=np.bool_))
    turn_length(layer_metric(cspace), pose[0, 3:], pose[0, 3:], 1.0)
    validity.configuration_is_free(cspace.scene, *pose[0, :7])
    GateFinder(cspace, *probe(cspace), 1.0, centring.new_workspace(cspace.scene)).compile_kernels()


@contextmanager
def compiling_aside(articulated: bool) -> Iterator[None]:
    """Compile the kernels in a process of its own while the block runs, unless they are there.

    If no process can be started, nothing happens: they are compiled when they are called.
    """
    process = None
    with suppress(OSError):
        (CACHE_FOLDER / _MARKS[articulated]).touch(exist_ok=False)
        process = subprocess.Popen(  # noqa: S603 (our own program)
            [sys.executable, "-c", _PROGRAM.format(articulated, os.getpid())],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    try:
        yield
        if process is not None:
            with compiling_elsewhere():
                process.wait(_LONGEST)
    except BaseException:
        if process is not None:
            process.kill()
            (CACHE_FOLDER / _MARKS[articulated]).unlink(missing_ok=True)
        raise


def main(articulated: bool, parent: int) -> None:
    """What the process does: compile for a scene of the simplest kind, while the parent lives."""
    end_with(parent)
    ball = Ellipsoid.from_semi_axes([1.0, 1.0, 1.0])
    world = World(np.full(3, -9.0), np.full(3, 9.0), (ball, ball))
    robot: RigidRobot | ArticulatedRobot = RigidRobot((ball,))
    if articulated:
        joint = Joint.of("joint", "one", "other", "continuous", [3.0, 0.0, 0.0])
        robot = ArticulatedRobot((Link("one", (ball,)), Link("other", (ball,))), (joint,))
    compile_passage_kernels(CSpace(world, robot))
