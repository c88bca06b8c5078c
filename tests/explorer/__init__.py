# SPDX-License-Identifier: GPL-3.0-or-later
"""A model of the whole library that a machine explores: steps drawn at random, performed in a child process, checked.

    python -m explorer --steps 2000                    # from tests/, or with it on the path
    python -m explorer --steps 100000 --journal soak   # stops and goes on where it was
    python -m explorer --replay soak/failures/….json

`steps` draws what to do next, `world` does it and judges what comes back, `host` keeps the child process that it
happens in.  There is one set of rules and two drivers: `drive` with plain seeds, and Hypothesis, which also shrinks.
"""
