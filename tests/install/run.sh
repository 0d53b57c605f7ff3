#!/bin/sh
# tests/install/run.sh BUILD_DIR
# Installs that build into a folder of its own and uses it from there in the four ways that others would.
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
build=$(CDPATH='' cd -- "${1:?usage: run.sh BUILD_DIR}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

fail() {
    echo "tests/install: $*" >&2
    exit 1
}

# Runs a program that must print the disk's area.
expect_area() {
    name=$1
    shift
    area=$("$@") || fail "$name: the program does not run"
    [ "$area" = 3.1416 ] || fail "$name: the disk's area is '$area', not 3.1416"
    echo "$name: ok"
}

# compile OUTPUT PREFIX FLAG...: by what pkg-config says of that installation.
compile() {
    output=$1 prefix=$2
    shift 2
    pc=$(find "$prefix" -name venule.pc)
    [ -n "$pc" ] || fail "no venule.pc was installed"
    PKG_CONFIG_PATH=$(dirname "$pc")${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
    export PKG_CONFIG_PATH
    # Unquoted on purpose: these are words.
    # shellcheck disable=SC2046
    "${CC:-cc}" -o "$output" "$here/main.c" $(pkg-config "$@" --cflags --libs venule)
}

cmake --install "$build" --prefix "$work/whole" >/dev/null || fail "the installation failed"
library=$(find "$work/whole" -name libvenule.so)
[ -n "$library" ] || fail "no libvenule.so was installed"

compile "$work/pc-shared" "$work/whole"
expect_area "pkg-config, shared" env LD_LIBRARY_PATH="$(dirname "$library")" "$work/pc-shared"

# The linker takes a shared library before a static one of the same name: here is an installation without it.
cp -R "$work/whole" "$work/static"
find "$work/static" -name 'libvenule.so*' -exec rm -f {} +
(compile "$work/pc-static" "$work/static" --static)
expect_area "pkg-config, static" "$work/pc-static"

cmake -S "$here" -B "$work/user" -DCMAKE_PREFIX_PATH="$work/whole" >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; fail "find_package(venule) failed"; }
cmake --build "$work/user" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "building by the CMake package failed"; }
expect_area "find_package, shared" "$work/user/with_shared"
expect_area "find_package, static" "$work/user/with_static"
