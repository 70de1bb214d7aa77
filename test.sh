#!/usr/bin/env bash
# Installs what is missing, builds, runs all tests. Closes with one line that counts the test cases.
. "$(dirname "${BASH_SOURCE[0]}")/tools/environment.sh"
usage() {
  cat <<'TEXT'
usage: ./test.sh [--asan] [--only REGEX] [--jobs N]
  --asan        build with address and undefined-behaviour sanitizers (in build/asan), run the tests that suit them
  --only REGEX  only the ctest tests that match
  --jobs N      tests at once (default: number of cores)
TEXT
}
only=() jobs="$(nproc)" sanitize=
while [ $# -gt 0 ]; do
  case "$1" in
    --asan) sanitize=1 ;;
    --only) [ $# -gt 1 ] || fail "--only takes a regular expression"; only=(-R "$2"); shift ;;
    --jobs) [ $# -gt 1 ] || fail "--jobs takes a number"; jobs="$2"; shift ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; fail "unknown argument '$1'" ;;
  esac
  shift
done
if [ -n "$sanitize" ]; then
  build_dir="$build_dir/asan" build_type=Debug
  # Checks of null and alignment make Eigen's templates take 3.5 times as long to compile; a null pointer stops the
  # program anyway, and Eigen asserts the alignment that it needs.
  cmake_arguments=("-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined -fno-sanitize=null,alignment -fno-omit-frame-pointer -O1 -g"
    -DOBJECT_MODELLING_SANITIZE=ON)
fi
install_missing
build
# No test runs them, so that nothing else checks that they compile.
[ -n "$sanitize" ] || build benchmarks
enter
rm -rf "$build_dir"/{test_results,Testing,sanitizer_reports,ros_home}
mkdir -p "$build_dir/sanitizer_reports"
result=0
(cd "$build_dir" && ctest --output-on-failure -j "$jobs" "${only[@]}") || result=$?
# A node's sanitizer report does not fail its rostest by itself.
if [ -n "$sanitize" ] && grep -rlE "ERROR: AddressSanitizer|runtime error:" "$build_dir/sanitizer_reports" 2>/dev/null; then
  echo "The sanitizers reported errors in the files above." >&2
  result=1
fi
/usr/bin/python3 "$root/tools/count_tests.py" "$build_dir" || result=1
exit "$result"
