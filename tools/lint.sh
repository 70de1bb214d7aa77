#!/usr/bin/env bash
# clang-format on every C++ file, and clang-tidy (naming, bugs) on those given or on all; needs clang-format-14 and
# clang-tidy-14, and a build folder for the compile commands.
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
if [ "${1:-}" = --format-only ]; then format_only=1; shift; fi
cd "$root"
mapfile -t files < <(git ls-files '*.cpp' '*.h')
clang-format-14 --dry-run --Werror "${files[@]}"
[ -n "${format_only:-}" ] && exit 0
[ -f "$build_dir/compile_commands.json" ] || fail "no compile commands in $build_dir: run ./run.sh true first"
if [ $# -gt 0 ]; then sources=("$@"); else mapfile -t sources < <(git ls-files 'src/**/*.cpp'); fi
# Without OpenMP: clang has a header of its own for it, in yet another package.
printf '%s\n' "${sources[@]}" | xargs -n 4 -P "$(nproc)" clang-tidy-14 -quiet -p "$build_dir" --extra-arg=-fno-openmp
