# SPDX-License-Identifier: GPL-3.0-or-later
"""How many instructions the dense kernels take with and without NEON, beside SSE2 and AVX2, counted by QEMU.

    apt-get install g++-aarch64-linux-gnu qemu-user
    python tools/arm64/count_instructions.py

Prints the table of docs/how-to/developing.md: the instructions of one call with a front of 64 columns and 192 rows
below them. Counts do not depend on the machine or its load, but instructions take different times. The plugin is for
QEMU up to version 8, as in Debian 12."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCES = HERE.parents[1] / "native" / "src"
KERNELS = ("eliminate", "substitute_forward", "substitute_backward", "add_gram")
NUMBERS = ("real", "complex")
CALLS = 10  # counted beyond the first one, which also has the start of the program
# Name, processor, and the options that differ from those of the wheel.
SETS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("arm64, one number at a time", "aarch64", ("-DEIGEN_DONT_VECTORIZE", "-fno-tree-vectorize")),
    ("arm64, NEON", "aarch64", ()),
    ("x64, SSE2", "x86_64", ()),
    ("x64, AVX2", "x86_64", ("-mavx2", "-mfma")),
)


def build(folder: Path, processor: str, options: tuple[str, ...]) -> Path:
    """The program of one instruction set, linked statically so that QEMU needs no system."""
    program = folder / "kernel_trial"
    command = [f"{processor}-linux-gnu-g++", "-std=c++17", "-O3", "-DNDEBUG", "-fcx-limited-range", "-static", *options]
    command += ["-DLSGP_INSTRUCTIONS=trial", "-DEIGEN_STACK_ALLOCATION_LIMIT=0", "-I", str(SOURCES)]
    command += ["-idirafter", "/usr/include/eigen3", str(HERE / "kernel_trial.cpp")]
    command += [str(SOURCES / "solvers" / "dense_kernels_for.cpp"), "-o", str(program)]
    subprocess.run(command, check=True)
    return program


def executed(counter: Path, processor: str, program: Path, kernel: str, numbers: str, times: int) -> int:
    """Instructions of the whole program."""
    command = [f"qemu-{processor}", "-cpu", "max", "-plugin", str(counter), str(program), kernel, numbers, str(times)]
    return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def per_call(counter: Path, processor: str, program: Path, kernel: str, numbers: str) -> float:
    """Instructions of one call."""
    once, more = (executed(counter, processor, program, kernel, numbers, times) for times in (1, CALLS + 1))
    return (more - once) / CALLS


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        counter = folder / "counter.so"
        plugin = ["gcc", "-O2", "-shared", "-fPIC", str(HERE / "instruction_counter.c"), "-o", str(counter)]
        subprocess.run(plugin, check=True)
        rows = [(kernel, numbers) for numbers in NUMBERS for kernel in KERNELS]
        table = []
        for title, processor, options in SETS:
            print(f"counting {title}", file=sys.stderr)
            program = build(folder, processor, options)
            table.append([per_call(counter, processor, program, *row) for row in rows])
    print("| thousands of instructions |", *(f"{title} |" for title, _, _ in SETS))
    print("|---|" + "--:|" * len(SETS))
    for (kernel, numbers), *counts in zip(rows, *table, strict=True):
        print(f"| `{kernel}`, {numbers} |", *(f"{count / 1000:,.1f} |" for count in counts))


if __name__ == "__main__":
    main()
