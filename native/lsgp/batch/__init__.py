# SPDX-License-Identifier: GPL-3.0-or-later
"""Many assets in one run: `lsgp batch`.

`command` reads as the run: `assets` are listed, split into `chunks`, given to a `pool` (or, by `dask_engine`, to those
of a cluster) that has a `worker_process` for each job; the process itself, `worker`, does the `work` on one asset after
the other; every outcome is a record that goes into the `journal` at once; `summary` and `contact_sheet` are made from
the records.
"""
