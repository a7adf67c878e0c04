"""The highway roadmap: layers of sweep lines, searched lazily; works without OMPL."""
