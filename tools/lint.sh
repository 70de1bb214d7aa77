#!/usr/bin/env bash
# clang-format on every C++ file; clang-tidy (naming, bugs) on every source of the libraries and nodes, in a build
# folder of its own, so that a second run looks only at what has changed. Needs clang-format-14 and clang-tidy-14.
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
cd "$root"
mapfile -t files < <(git ls-files '*.cpp' '*.h')
clang-format-14 --dry-run --Werror "${files[@]}"
[ "${1:-}" != --format-only ] || exit 0
build_dir="${OBJECT_MODELLING_LINT_DIR:-$root/build_lint}"
# Without OpenMP: clang has a header of its own for it, in yet another package.
cmake_arguments=(-DCATKIN_ENABLE_TESTING=OFF "-DCMAKE_CXX_CLANG_TIDY=clang-tidy-14;-quiet;--extra-arg=-fno-openmp")
build object_modelling_programs -- -k 0  # all findings, not the first alone
echo "No findings in ${#files[@]} files."
