# SPDX-License-Identifier: GPL-3.0-or-later
# What tools/demo and tools/test need on a fresh Debian-like machine; to be sourced by them.
#
# PYTHON names the Python 3.11 to use.
export PIP_DISABLE_PIP_VERSION_CHECK=1
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
venv=$root/build/venv
at_once=(-n auto --maxprocesses 8)  # arguments of pytest-xdist
slowest=(--durations=25 --durations-min=5)  # of pytest: where the time goes is printed at the end
cache=${XDG_CACHE_HOME:-$HOME/.cache}/cone-unwrap

say() { printf '\n== %(%T)T %s\n' -1 "$*"; }
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Installs Debian packages; says which ones to install where it may not.
install_packages() {
    command -v apt-get >/dev/null || fail "please install these (Debian's names): $*"
    say "installing $*"
    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || fail "please install as root: apt-get install $*"
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

find_python() {
    local name
    for name in ${PYTHON:+"$PYTHON"} python3.11 python3 python; do
        if "$name" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null; then
            command -v "$name"
            return
        fi
    done
}

# A compiler, headers and a Python; sets `python`. Where ccache is installed, what an earlier build has compiled is not
# compiled again.
set_up_system() {
    local missing=()
    command -v c++ >/dev/null || missing+=(g++)
    [ -e /usr/include/eigen3/Eigen/Core ] || missing+=(libeigen3-dev)
    [ -e /usr/include/Spectra/SymEigsSolver.h ] || missing+=(libspectra-dev)
    python=$(find_python)
    [ -n "$python" ] || fail "no Python 3.11 found; install it or name it in PYTHON"
    "$python" -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3.11-venv)
    "$python" -c 'import os, sysconfig; os.stat(os.path.join(sysconfig.get_path("include"), "Python.h"))' 2>/dev/null ||
        missing+=(python3.11-dev)
    [ ${#missing[@]} = 0 ] || install_packages "${missing[@]}"
    if command -v ccache >/dev/null; then
        set_up_ccache
    fi
}

# Keeps what was compiled, where it is installed or can be: the wheel and the C++ tests take the same objects.
set_up_ccache() {
    command -v ccache >/dev/null || (install_packages ccache) || return 0
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_DIR=$cache/ccache
}

# The header of the C++ unit tests.
set_up_unit_tests() { [ -e /usr/include/doctest/doctest.h ] || install_packages doctest-dev; }

# What makes the reference of the C++ library.
set_up_doxygen() { command -v doxygen >/dev/null || install_packages doxygen; }

# A Clang with the runtimes of its sanitizers and fuzzer; sets `clang`. CLANG names another than Debian's clang++.
set_up_clang() {
    clang=${CLANG:-clang++}
    command -v "$clang" >/dev/null || install_packages clang
    [ -e "$("$clang" -print-file-name="libclang_rt.fuzzer-$(uname -m).a")" ] ||
        install_packages "libclang-rt-$("$clang" -dumpversion | cut -d. -f1)-dev"
}

# The Python that runs the fuzzers, in $fuzz_venv.
fuzz_venv=$root/build/fuzz/venv
set_up_fuzz_python() {
    mkdir -p "$root/build/fuzz"
    set_up_python "$fuzz_venv" 'atheris' 'numpy' 'scipy'
}

# clang-tidy; CLANG_TIDY names another than Debian's newest.
set_up_clang_tidy() {
    export CLANG_TIDY=${CLANG_TIDY:-clang-tidy-19}
    command -v "$CLANG_TIDY" >/dev/null || install_packages "$CLANG_TIDY"
}

# Runs the command after $1, which says what it does; while it takes, a line says so every eight seconds.
patiently() {
    local what=$1 status=0 talker began=$SECONDS
    shift
    (
        trap 'kill "$pause"; exit' TERM
        while kill -0 $$; do
            sleep 8 &
            pause=$!
            wait "$pause"
            printf '   %s: %d s\n' "$what" $((SECONDS - began))
        done
    ) >&2 &
    talker=$!
    "$@" || status=$?
    kill "$talker"
    wait "$talker" 2>/dev/null || true
    return "$status"
}

# Makes a virtual environment, once: $1 its folder, then what to install there.
set_up_python() {
    local folder=$1
    shift
    if [ "$(cat "$folder/installed" 2>/dev/null)" != "$*" ]; then
        say "installing $* in $folder"
        patiently "installing" install_in_python "$folder" "$@"
        printf '%s\n' "$*" >"$folder/installed"
    fi
}

install_in_python() {
    local folder=$1
    shift
    { [ -x "$folder/bin/python" ] || "$python" -m venv "$folder"; } && "$folder/bin/pip" install -q "$@"
}

# The Python that runs all tests, in $venv.
set_up_test_python() {
    set_up_python "$venv" 'numpy' 'scipy' 'pytest' 'hypothesis' 'ruff' 'distributed' 'quickjs' 'openjd-cli' 'pytest-xdist' \
        'plyfile' 'trimesh' 'meshio' 'libigl' 'pyvista' 'opencv-python-headless' 'manifold3d' \
        'cmake' 'ninja' 'clang-format==19.1.7' 'mkdocs-material' 'mypy' 'basedpyright' 'scikit-build-core'
}

# The bpy wheel of Blender $2 (4.5, ...; about 400 MB) in virtual environment $1, with the packages that follow; it brings
# Blender's own libraries, not those of the window system, which it links even when headless.
set_up_bpy() {
    set_up_python "$1" "bpy==$2.*" 'numpy<2' "${@:3}"
    if ldd "$1"/lib/python3.11/site-packages/bpy/__init__*.so | grep -q 'not found'; then
        install_packages libx11-6 libxi6 libxrender1 libxfixes3 libxkbcommon0 libsm6 libice6 libgl1
    fi
}

# Blender 4.5 as a Python module, which runs the add-on's tests.
blender_venv=$cache/bpy-4.5
set_up_test_bpy() { set_up_bpy "$blender_venv" 4.5 'pytest'; }

real_blender=$root/../shared/tools/real-blender

# Whether real Blenders can be installed here.
has_real_blenders() { [ -x "$real_blender" ] && [ "$(id -u)" = 0 ]; }

# The Blender of Debian's suite $1 with its window and all that building a wheel takes, in $cache/blender-$1; installed
# once, a few minutes. Prints the folder; what the installation says goes to the standard error.
set_up_real_blender() {
    local folder=$cache/blender-$1
    {
        mkdir -p "$root/build"
        say "setting up the Blender of Debian $1 in $folder"
        "$real_blender" install "$1" "$folder" build gui >"$root/build/blender-$1.log" 2>&1 &&
            BLENDER_EXE=sh "$real_blender" run "$folder" -c \
                'set -- ccache libeigen3-dev libspectra-dev
                dpkg -s "$@" >/dev/null 2>&1 || { apt-get update -q && apt-get install -y -q "$@"; }' \
                >>"$root/build/blender-$1.log" 2>&1 ||
            { tail -n 20 "$root/build/blender-$1.log"; fail "the Blender of Debian $1 could not be installed"; }
    } >&2
    printf '%s\n' "$folder"
}

# A digest of all that a wheel is made of.
digest_of_sources() {
    local sources=(native CMakeLists.txt pyproject.toml blender_manifest.toml)
    (cd "$root" && find "${sources[@]}" -type f ! -name '*.pyc' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum) |
        sha256sum | cut -d' ' -f1
}

# Builds the wheel into folder $1 with the command that follows, unless one of the same sources is there. Its files have
# the time of the last commit, so that the same sources give the same bytes; SOURCE_DATE_EPOCH names another.
build_wheel_by() {
    local folder=$1 digest
    shift
    digest=$(digest_of_sources)
    if [ "$(cat "$folder/sources" 2>/dev/null)" = "$digest" ]; then
        say "taking the lsgp wheel in $folder, which is of these sources"
        return
    fi
    say "building the lsgp wheel"
    rm -rf "$folder"
    SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$root" log -1 --format=%ct 2>/dev/null || echo 315532800)} \
        patiently "building" "$@" || return
    printf '%s\n' "$digest" >"$folder/sources"
}

# Builds the wheel for our own Python into folder $2 with virtual environment $1, unless one of the same sources is there.
build_wheel() { build_wheel_by "$2" "$1/bin/python" -m pip wheel -q "$root" --no-deps -w "$2"; }
