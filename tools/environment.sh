# What demo.sh, test.sh and run.sh share: install what is missing, build, enter the build's environment. Sourced by bash.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build_dir="${OBJECT_MODELLING_BUILD_DIR:-$root/build}"
build_type="${OBJECT_MODELLING_BUILD_TYPE:-Release}"
cmake_arguments=()

fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# ROS of packages.ros.org, which Ubuntu 20.04 takes; Debian's own is in /usr and needs nothing sourced.
ros_folder=
[ ! -f /opt/ros/noetic/setup.bash ] || ros_folder=/opt/ros/noetic
if [ -n "$ros_folder" ]; then
  # catkin's setup files use unset variables.
  set +u
  . "$ros_folder/setup.bash"
  set -u
fi

# wanted_packages RELEASE [ROS]: what of tools/packages.txt to install on a release (code name), one a line; ROS: the
# distribution in /opt/ros, if there is one.
wanted_packages() {
  awk -v release="$1" -v ros="${2:-}" '
    /^#/ || !NF { next }
    $3 ~ /^-/ && index("," substr($3, 2) ",", "," release ",") { next }
    $3 == "ros" && ros { gsub("_", "-", $2); $1 = "ros-" ros "-" $2 }
    { print $1 }' "$root/tools/packages.txt" | sort -u
}

missing_packages() {
  local wanted
  wanted="$(wanted_packages "$(. /etc/os-release && echo "${VERSION_CODENAME:-}")" "$(basename "$ros_folder")")"
  # Lists what is installed; unknown names go to stderr.
  comm -23 <(echo "$wanted") <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null |
    awk '$1 == "installed" {print $2}' | sort -u)
}

install_missing() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null ||
    { echo "No apt here: install what package.xml lists with rosdep, and libsoci-dev." >&2; return; }
  local missing as_root=()
  missing="$(missing_packages)"
  [ -n "$missing" ] || return 0
  if [ -d /opt/ros ] && [ -z "$ros_folder" ]; then
    echo "ROS is in /opt/ros, but it is not Noetic: install what package.xml lists with rosdep, and libsoci-dev." >&2
    return 0
  fi
  [ "$(id -u)" = 0 ] || { command -v sudo >/dev/null && as_root=(sudo) ||
    fail "these packages are missing, and there is no sudo to install them with:" $missing; }
  echo "Installing" $(wc -w <<<"$missing") "packages:" $missing
  "${as_root[@]}" apt-get update -qq || fail "apt-get update failed: is the network up?"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
    fail "installing failed; see above, then run again"
}

# build [TARGET...]: configures if needed, builds these targets, or everything.
build() {
  mkdir -p "$build_dir"
  local launcher=() log="$build_dir/configure.log"
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    # Relative paths in the cache's keys: another clone of the same tree finds what this one compiled.
    # The last: it may keep what was compiled with precompiled headers.
    export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  fi
  # Messages for C++ and Python; the other languages' would take as long again.
  export ROS_LANG_DISABLE="${ROS_LANG_DISABLE-geneus:genlisp:gennodejs}"
  if [ ! -f "$build_dir/build.ninja" ] || [ "${#cmake_arguments[@]}" -gt 0 ]; then
    echo "Configuring in $build_dir"
    # An own PATH for the build: a pyenv or venv python3 has no modules of ROS.
    PATH="/usr/bin:$PATH" cmake -S "$root" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" \
      -DOBJECT_MODELLING_WARNINGS_AS_ERRORS=ON \
      -DOBJECT_MODELLING_UNITY_BUILD="${OBJECT_MODELLING_UNITY_BUILD:-ON}" "${launcher[@]}" "${cmake_arguments[@]}" >"$log" 2>&1 ||
      { tail -n 30 "$log" >&2; fail "configuring failed; the whole log is $log"; }
  fi
  local command=(cmake --build "$build_dir")
  [ $# -eq 0 ] || command+=(--target "$@")
  if [ -t 1 ]; then
    PATH="/usr/bin:$PATH" "${command[@]}"
  else
    # Without a terminal ninja prints a line a step; catkin checks its messages in every build.
    PATH="/usr/bin:$PATH" "${command[@]}" | { grep --line-buffered -v 'no work to do\|genmsg_check_deps' || true; }
  fi
}

enter() {
  # catkin's setup files use unset variables.
  set +u
  . "$build_dir/devel/setup.sh"
  set -u
  export PATH="/usr/bin:$build_dir/devel/lib/object_modelling:$PATH"
  # Works without name resolution; whoever runs on several machines sets ROS_IP or ROS_HOSTNAME.
  [ -n "${ROS_IP:-}${ROS_HOSTNAME:-}" ] || export ROS_HOSTNAME=localhost
  export ROSCONSOLE_STDOUT_LINE_BUFFERED=1
}
