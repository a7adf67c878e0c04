"""The configuration space of a robot among ellipsoids, characterised in closed form."""
