#!/usr/bin/env bash
# Runs any command in the build's environment: ./run.sh roslaunch object_modelling object_modelling.launch
. "$(dirname "${BASH_SOURCE[0]}")/tools/environment.sh"
if [ $# -eq 0 ] || [ "$1" = -h ] || [ "$1" = --help ]; then
  cat <<'TEXT'
usage: ./run.sh COMMAND [ARGUMENT...]
Builds if needed, then runs the command with our nodes, messages and Python package found:
  ./run.sh object_modelling track my_recording --trajectory out.txt
  ./run.sh roslaunch object_modelling object_modelling.launch
  ./run.sh rviz
TEXT
  exit 0
fi
install_missing >&2
build object_modelling_programs >&2
enter
exec "$@"
