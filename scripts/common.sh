# What the scripts in this folder share; they source it from bash:
#
#   root                      the top folder of the repository
#   say TEXT                  print a heading
#   install_missing PACKAGE.. install Debian packages that are not there yet
#   parallel_jobs             print how many compilers may run at a time
#   build FOLDER TARGETS [CMAKE OPTION..]
#                             configure (Release, Ninja) and build
#   run_mpi RANKS COMMAND..   run COMMAND on RANKS ranks

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

build_packages=(cmake ninja-build g++ mold libdeal.ii-dev openmpi-bin libnlopt-cxx-dev
                libjemalloc-dev)
test_packages=(numdiff perl git python3 clang-format-14)
report_packages=(python3 python3-vtk9 python3-matplotlib python3-numpy xvfb)

# mpirun does not start as root unless it is told twice that this is meant.
if [ "$(id -u)" -eq 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

# Containers often forbid one process to read another's memory; Open MPI then prints an
# error for every message. The copy that it saves does not matter for messages of our size.
export OMPI_MCA_btl_vader_single_copy_mechanism=none

say() {
  printf '\n==> %s\n' "$*"
}

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

install_missing() {
  local package missing=() as_root=()
  if ! command -v dpkg-query >/dev/null; then
    say "This is not Debian: taking for granted that what these packages hold is there: $*"
    return
  fi
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    return
  fi
  say "Installing ${missing[*]}"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "These packages are missing, and there is no sudo to install them with; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y
             -o Dpkg::Use-Pty=0 -o Acquire::Retries=3)
  "${apt[@]}" update </dev/null
  "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null
}

# As many as there are processors that this process may use, but no more than the memory
# allows: a source file that includes the larger headers of deal.II takes about 1.5 GB.
parallel_jobs() {
  local jobs memory limit quota period
  jobs=$(nproc)
  if [ -r /sys/fs/cgroup/cpu.max ]; then
    read -r quota period </sys/fs/cgroup/cpu.max
    if [ "$quota" != max ] && [ $(((quota + period - 1) / period)) -lt "$jobs" ]; then
      jobs=$(((quota + period - 1) / period))
    fi
  fi
  memory=$(awk '/^MemAvailable:/ {print int($2 / 1024)}' /proc/meminfo) # MB
  for limit in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
    if [ -r "$limit" ] && grep -qE '^[0-9]{1,15}$' "$limit" &&
      [ $(($(cat "$limit") / 1048576)) -lt "$memory" ]; then
      memory=$(($(cat "$limit") / 1048576))
    fi
  done
  if [ $((memory / 1500)) -lt "$jobs" ]; then
    jobs=$((memory / 1500))
  fi
  echo $((jobs < 1 ? 1 : jobs))
}

build() {
  local folder=$1 targets=$2
  shift 2
  local linker_flags=
  if command -v mold >/dev/null; then
    linker_flags=-fuse-ld=mold
  fi
  # A build folder that was made by another generator, or in another place, is of no use.
  if [ -f "$folder/CMakeCache.txt" ] &&
    ! { grep -qx "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt" &&
        grep -qx "CMAKE_GENERATOR:INTERNAL=Ninja" "$folder/CMakeCache.txt"; }; then
    rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
  fi
  say "Configuring $folder"
  cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_EXE_LINKER_FLAGS="$linker_flags" "$@"
  say "Building $targets"
  # shellcheck disable=SC2086 # the targets are several words
  cmake --build "$folder" --parallel "$(parallel_jobs)" --target $targets
}

run_mpi() {
  local ranks=$1 options=() cores
  shift
  cores=$(lscpu -p=Core,Socket 2>/dev/null | grep -v '^#' | sort -u | wc -l)
  if [ "$(nproc)" -lt "$ranks" ]; then
    options=(--oversubscribe)
  elif [ "$cores" -lt "$ranks" ]; then
    options=(--use-hwthread-cpus)
  fi
  mpirun "${options[@]}" -np "$ranks" "$@"
}
