# SPDX-License-Identifier: GPL-3.0-or-later
"""Goals for speed that are reached and missed, and what the time of the missed ones is spent on; for `benchmark.py`.

Written by hand: shares are those of a profiler's samples on one thread of a shared machine, times CPU seconds there.
"""

from __future__ import annotations

REACHED = """\
## Goals

Reached: with a million triangles 0.12 times the CPU time of libigl's LSCM, with 200,000 and more less than the cheaper
bare Laplacian; with two threads 2.5 s for a million triangles, 14 s of CPU time of the calling thread for 4 million and
40 s for 10 million, which take 10 GB (61 s passed on a machine shared with others); the same bytes for any number of
threads (tests compare 1, 2, 3 and 8); a preview of a dragged cone in 33 ms with 100,000 triangles and 0.13 to 0.18 s
with a million, once the reduced surface is made (0.1 and 2 s); an angle edited in 9 ms with 20,000 triangles; eight
cones placed in 2.1 times the time of the map with 200,000 triangles and 1.7 times with a million; low stretch in 4.3
and 5.2 times with 50,000 and 200,000, a seamless layout in at most 1.9 times, a split where nothing overlaps in 1.1
times; a file of a million triangles read in 0.42 s (OFF), 0.20 s (binary PLY) and 0.45 s (PLY as text), and written in
0.44 s (OBJ) and 0.23 s (binary PLY); a million quads cut into triangles in 0.3 s.

Missed, with the shares of what remains:
"""

MISSED = (
    (
        "the map beside libigl's LSCM",
        "0.35 with 50,000, 0.2 with 200,000",
        "0.54, 0.39",
        "With 50,000 triangles: cuts 28 % (the tree 5, exchanges of paths 23), the factor 15 %, its ordering 13 %, "
        "prescription and unfolding without it 22 %, topology and geometry 10 %, checks, layout and overlaps 9 %. "
        "LSCM is given the cuts and checks nothing. Without cuts and checks lsgp would have 0.34 and 0.26 of its "
        "time.",
    ),
    (
        "the map beside the cheaper Laplacian",
        "1.0 with 50,000",
        "1.48",
        "As above: the factor and its ordering take half the time of the bare Laplacian, all other stages the rest.",
    ),
    (
        "100 and 500 random cones beside 8",
        "2, 3.5",
        "2.5, 4.4 with 50,000; 2.6, 3.8 with 200,000",
        "The complex factor of the transitions is a third of it, solves a fifth (see above). Dissection with the "
        "translations of 99 cuts in all separators makes unfolding take 1.8 times as long.",
    ),
    (
        "two threads beside one",
        "1.7 times as fast",
        "1.26",
        "The calling thread alone takes 76 % of all CPU time with 200,000 triangles and 71 % with a million, which "
        "allows 1.3 and 1.4 even without any waiting. What no other thread does: cuts 25 and 16 %, levels, symbolic "
        "factorization and lists of neighbors 8 and 7 %, topology 6 and 5 %, assembling 2 %. The rest is its part of "
        "what is divided; with a million, a tenth of all time are pages of memory that the system clears. Each "
        "exchange of cuts depends on those before it.",
    ),
    (
        "low stretch beside libigl's SLIM",
        "5 times as fast",
        "1.6 to 2.8",
        "Newton's method takes three steps, four with a million triangles, each a factorization with two unknowns for "
        "each vertex: 58 % of the time, 73 % with a million. SLIM takes three or four steps of the same size from "
        "Tutte's map, so that five times as fast would be less than one of them.",
    ),
    (
        "low stretch beside the map",
        "6 with a million",
        "7.8",
        "The same factorizations; their time grows with the power 1.4 of the triangles, that of the map with 1.2.",
    ),
    (
        "eight cones placed beside the map",
        "4 with 50,000",
        "7.5",
        "Columns of the variance matrix, two solves each, for sites that are tried in exchanges: 62 %; the estimate "
        "of its diagonal 13 %; the map that verifies the cones 8 %. From 80,000 triangles on, cones are chosen on a "
        "coarse surface.",
    ),
    (
        "`lsgp unwrap --cones auto:8`, a million triangles",
        "9 s",
        "11.6 s",
        "Placement with the map that verifies it 70 %, costs of cuts by visibility 13 %, the map from the factor that "
        "is kept 7 %, reading and triangulating 5 %, writing 5 %.",
    ),
    (
        "a preview of a dragged cone",
        "20 ms with 20,000",
        "20 to 27 ms",
        "It maps 8,000 triangles: prescription takes almost half of the time, unfolding a tenth, topology, layout and "
        "checks a fifth, the reduced surface with its cones and the way back to the whole one a quarter. With 5,000 it "
        "takes two thirds as long.",
    ),
    (
        "the exact map of a moved cone, two threads",
        "20 ms with 20,000, 60 ms with 100,000, 0.4 s with a million",
        "35 ms, 0.3 s, 2.2 s of the calling thread",
        "Nothing of the factor is kept: another cone has other cuts, so that the opened surface has other rows and "
        "another order. Prescription with cuts and factor takes three quarters, unfolding an eighth. The map with "
        "100,000 triangles overlaps itself, which takes a quarter more. While a cone is dragged, previews take its "
        "place.",
    ),
    (
        "an angle edited",
        "10 ms with 50,000",
        "21 ms, with two threads 16 ms on the calling one",
        "Unfolding 9 ms (frames and a solve), the layout 6, checks 3, prescription 1: linear passes over all "
        "triangles, since an angle changes the map everywhere.",
    ),
    (
        "files of a million triangles",
        "0.5 s",
        "OBJ read in 0.46 to 0.8 s, PLY as text written in 0.8 s",
        "The places of all tokens of an OBJ, whose memory the system clears, which varies. PLY as text is read once "
        "more, with the properties that are kept; then shortest decimal numbers of coordinates.",
    ),
    (
        "a build without ccache",
        "150 CPU seconds; 20 after an edit of one stage",
        "247; 27 after one of `seamless`",
        "Templates of Eigen in every batch of folders that is compiled as one source: `seamless` and the kernels, "
        "which are compiled twice, have a quarter of the time. Without the unity build an edit takes 5 to 11 seconds, "
        "but all of it 360.",
    ),
)


def goals() -> str:
    lines = ["| | goal | reached | what remains, and why |", "|---|---|---|---|"]
    return REACHED + "\n" + "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in MISSED)])
