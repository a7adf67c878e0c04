"""Search trees that grow by proved motions towards free samples; works without OMPL."""
