"""Lets ``python -m planners.cli`` stand for ``ellipsoid-planning``."""

from planners.cli.main import main

main()
