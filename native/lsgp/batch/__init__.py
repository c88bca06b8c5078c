# SPDX-License-Identifier: GPL-3.0-or-later
"""Many assets in one run: `lsgp batch`.

`command` reads as the run: `assets` are listed, split into `chunks`, given to a `pool` of worker processes (or, by
`dask_engine`, to those of a cluster), each of which does the `work` on one asset after the other; every outcome is a
record that goes into the `journal` at once; `summary` and `contact_sheet` are made from the records.
"""
