#!/usr/bin/env bash
# Installs what is missing, builds, starts the nodes, plays a recording into them and drives the session by services; or
# models two objects and has the recogniser find them.
. "$(dirname "${BASH_SOURCE[0]}")/tools/environment.sh"
usage() {
  cat <<'TEXT'
usage: ./demo.sh [--handheld | --recognise | --recording PATH [--reference scene|object]] [--headless] [--out FOLDER]
  (nothing)         the real recording that ships with the project: a cereal box on a turntable
  --handheld        the simulated handheld recording that ships with the project: a bottle on a table, 30 Hz
  --recognise       models the bottle and a sugar box (simulated), and finds both among other things, with pictures
  --recording PATH  your own TUM-style folder or ROS bag
  --reference WHAT  what it is tracked against: scene (default) or object (turntable, object in motion)
  --headless        no rviz, even with a display
  --out FOLDER      where sessions and model go (default: demo/ in the build folder)
TEXT
}
recording="$root/test/data/cereal_box_turntable" reference=object object_id=cereal_box
rviz=false recognise=false out="$build_dir/demo"
[ -n "${DISPLAY:-}" ] && rviz=true
while [ $# -gt 0 ]; do
  case "$1" in
    --handheld) recording="$root/test/data/mustard_handheld_simulated" reference=scene object_id=mustard_bottle ;;
    --recognise) recognise=true ;;
    --recording)
      [ $# -gt 1 ] || fail "--recording takes a path"
      recording="$(realpath -m "$2")" reference=scene object_id=my_object; shift ;;
    --reference) [ $# -gt 1 ] || fail "--reference takes scene or object"; reference="$2"; shift ;;
    --headless) rviz=false ;;
    --out) [ $# -gt 1 ] || fail "--out takes a folder"; out="$(realpath -m "$2")"; shift ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; fail "unknown argument '$1'" ;;
  esac
  shift
done
[ -e "$recording" ] || fail "recording '$recording' does not exist"

install_missing
build object_modelling_programs
enter
mkdir -p "$out" || fail "cannot write to $out: choose another folder with --out"

# A master of its own, so that the demo meets no other nodes.
port="$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')"
export ROS_MASTER_URI="http://localhost:$port" ROS_HOME="$out/ros_home"
log="$out/nodes.log"
if [ "$recognise" = true ]; then
  scene="$root/test/data/clutter_simulated" objects="$out/recognition/objects"
  object_modelling model mustard_bottle "$root/test/data/mustard_handheld_simulated" --database "$objects"
  object_modelling model sugar_box "$root/test/data/sugar_box_simulated" --database "$objects"
  launch=(recognition_demo.launch scene:="$scene" database_path:="$objects")
  drive=(recognition_demo "$scene" --wait-for mustard_bottle sugar_box --out "$out/recognition")
else
  launch=(demo.launch drive:=false recording:="$recording" reference:="$reference" store_path:="$out/keyframes.sqlite"
    database_path:="$out/objects")
  drive=(demo "$recording" --object-id "$object_id")
fi
roslaunch -p "$port" object_modelling "${launch[@]}" rviz:="$rviz" >"$log" 2>&1 &
nodes=$!
stop_nodes() { kill -INT "$nodes" 2>/dev/null && wait "$nodes" 2>/dev/null || true; }
trap stop_nodes EXIT
trap 'exit 130' INT TERM

for _ in $(seq 100); do (exec 3<>"/dev/tcp/localhost/$port") 2>/dev/null && break || sleep 0.1; done
result=0
"${drive[@]}" || result=$?
if [ "$result" -ne 0 ]; then
  tail -n 15 "$log" >&2
  fail "the demo did not end well (exit code $result); all that the nodes said is in $log"
fi
echo "nodes:   $log"
if [ "$rviz" = true ]; then
  echo "rviz shows it. Close it with Ctrl-C here."
  wait "$nodes" || true
fi
