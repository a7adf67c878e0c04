"""A search for false certificates, which aims at where numbers cancel.

Random motions never come near the places where a proof rests on a difference of nearly equal
numbers. The cases here are built to lie there; `judge` decides about them without the kernels, in
long double and with decimals. The suite runs some seconds of it, `benchmarks/adversarial.py` as
long as one likes.

`judge` is about pairs of bodies and knows no robot. Each kind of robot has its own `*_motion`
(where its parts are), `*_cases` (how to aim) and `*_search` (what came of it).
"""
