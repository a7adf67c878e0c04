"""The OMPL plug-in: exact validity, certified motions, collision-free sampling and whole plans.

Import what you need from the modules, so that nothing heavy is loaded before it is used::

    from ompl import geometric as og
    from ellipsoid_planning.scenario import load_scenario
    from planners.setup import simple_setup

    setup = simple_setup(load_scenario("rabbit-2d-open"))
    setup.setPlanner(og.RRTConnect(setup.getSpaceInformation()))
    setup.solve(1.0)

Build OMPL's objects inside functions: module-level ones outlive the bindings, which then report
them as leaked when the interpreter exits.
"""
