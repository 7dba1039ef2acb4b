#!/usr/bin/env bash
# Runs VisionServer with a simulated pair of GigE Vision cameras: installs what is missing, builds,
# starts cameras and server, and says where to look.
#
#   deploy/run.sh [--duration SECONDS] [--fps N] [--port N] [--web-port N] [--folder DIR]
#                 [--data DIR] [--wait SECONDS]
#
#   --duration SECONDS  end by itself after so many seconds of depth; without it, Ctrl-C ends it
#   --fps N             pairs per second that the cameras are triggered for (default 30)
#   --port N            where the server listens on this machine (default 50051; 0: any free port)
#   --web-port N        where the page for browsers is (default 8443; any free port with --port 0)
#   --folder DIR        serve the picture pairs of a folder in place of the simulated scene
#   --data DIR          what the server stores (default: ~/.local/state/visionserver-demo)
#   --wait SECONDS      give up when no depth comes for so long (default 60)
#
# Where VISIONSERVER_BIN names a folder with the programs, nothing is installed or built.
#
# Exit code: 0 if depth was streamed to the end, 130 after Ctrl-C, 2 for wrong usage, otherwise 1.
set -euo pipefail

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; }
die() { printf 'run.sh: %s\n' "$*" >&2; exit "${code:-1}"; }
whole() { [[ $2 =~ ^[0-9]{1,9}$ ]] || code=2 die "$1 needs a whole number, not \"$2\""; }

duration='' fps=30 port=50051 web_port='' folder='' wait=60
data=${XDG_STATE_HOME:-$HOME/.local/state}/visionserver-demo
while (($#)); do
  case $1 in
    --duration | --fps | --port | --web-port | --folder | --data | --wait)
      (($# > 1)) || code=2 die "$1 needs a value; see --help"
      name=${1#--}
      printf -v "${name//-/_}" %s "$2"
      shift 2 ;;
    --help | -h) usage; exit ;;
    *) code=2 die "unknown option $1; see --help" ;;
  esac
done
[[ -z $duration ]] || whole --duration "$duration"
whole --port "$port"
: "${web_port:=$((10#$port ? 8443 : 0))}"
whole --web-port "$web_port"
whole --wait "$wait"
[[ $fps =~ ^[0-9]+([.][0-9]+)?$ && $fps =~ [1-9] ]] ||
  code=2 die "--fps needs a number above 0, not \"$fps\""
[[ -z $folder || -d $folder ]] || code=2 die "--folder: there is no folder $folder"
folder=${folder:+$(realpath -- "$folder")}
data=$(realpath -m -- "$data")
bin=$(realpath -m -- "${VISIONSERVER_BIN:-$(dirname "$0")/../build/release/bin}")

cd "$(dirname "$0")/.."
[[ -n ${VISIONSERVER_BIN:-} ]] || deploy/prepare.sh

# What we start is ours to end, whatever happens.
cameras='' server=''
work=$(mktemp -d)

# Each child has a session of its own, so that the terminal's Ctrl-C reaches this script alone and
# the server is asked once, which it takes as time to drain. Nothing outlives this script.
apart() { exec setsid setpriv --pdeathsig TERM "$@"; }

# The server first: it drains while its cameras still live.
finish() {
  local code=$? name
  trap - EXIT HUP INT TERM
  for name in server cameras; do
    [[ -n ${!name} ]] || continue
    kill "${!name}" 2>/dev/null || true
    if wait "${!name}"; then
      echo "The $name ended in order."
    else
      echo "run.sh: the $name did not end in order: $(last_words)" >&2
      ((code)) || code=1
    fi
  done
  rm -rf "$work"
  exit "$code"
}
trap finish EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

last_words() { tail -qn 3 "$work"/*.err 2>/dev/null || true; }

# Ends with the reason when cameras or server have ended by themselves.
all_live() {
  local name pid status
  for name in cameras server; do
    pid=${!name}
    if [[ -z $pid ]] || kill -0 "$pid" 2>/dev/null; then continue; fi
    status=0
    wait "$pid" || status=$?
    printf -v "$name" ''
    die "the $name ended with code $status: $(last_words)"
  done
}

# Waits until a command succeeds; gives up after --wait seconds.
await() { # what-failed command...
  local what=$1 end=$((SECONDS + 10#$wait))
  shift
  until "$@"; do
    all_live
    ((SECONDS < end)) || die "$what within $((10#$wait)) s: $(last_words)"
    sleep 0.1
  done
}

# The server's newest line about depth, "stereo_depth: 9.8 fps, 85 ms latency, 42 frames, 0 dropped".
report() { grep '^stereo_depth: ' "$work/server" | tail -n 1; }
frames() { report | sed 's/.* \([0-9]*\) frames.*/\1/'; }
more_frames_than() { (($(frames) > $1)); }

mkdir -p "$data"/{sequences,rigs}
chmod 700 "$data"
[[ -e $data/sequences/stereo_depth.json ]] || cp deploy/demo/stereo_depth.json "$data/sequences/"
[[ -e $data/rigs/demo.json ]] || cp deploy/demo/rig.json "$data/rigs/demo.json"
quoted=${data//\\/\\\\}
quoted=${quoted//\"/\\\"}
config=$(<deploy/demo/server.conf)
config=${config//@DATA@/"$quoted"}
config=${config//@WEB_PORT@/$((10#$web_port))}
printf '%s\n' "${config//@PORT@/$((10#$port))}" >"$work/server.conf"

apart "$bin/gevsim" --fps "$fps" ${folder:+--folder "$folder"} \
  >"$work/cameras" 2>"$work/cameras.err" &
cameras=$!
await 'the cameras were not ready' grep -qs '^gevsim ready' "$work/cameras"

apart "$bin/visionserver" --config "$work/server.conf" --report 1 \
  >"$work/server" 2>"$work/server.err" &
server=$!
await "no depth came from the sequence $data/sequences/stereo_depth.json" \
  grep -qs '^stereo_depth: ' "$work/server"

address=$(sed -n 's/^VisionServer .* listens on \([^ ]*\).*/\1/p' "$work/server")
page=$(sed -n 's/^the page is at //p' "$work/server")
fingerprint=$(sed -n 's/^certificate fingerprint (SHA-256): //p' "$work/server")
password=$(sed -n 's/^one-time password of the user admin.*: //p' "$work/server")

cat <<TEXT

VisionServer streams depth from two simulated GigE cameras: $(report | grep -o '[0-9.]* fps')

  page         $page
  address      $address
  fingerprint  $fingerprint
  admin        ${password:-(the password that you chose at the first login)}

Try next:
  $bin/visionctl login admin --server $address --fingerprint $fingerprint
  $bin/visionctl depth stereo_depth --frames 5 --out depth --stats
  $bin/visionctl set stereo_depth match.p2 20

TEXT
[[ -n $duration ]] || echo 'Ctrl-C ends it.'

started=$SECONDS
first=$(frames)
shown=''
until [[ -n $duration ]] && ((SECONDS - started >= 10#$duration)); do
  all_live
  now=$(report)
  if [[ -t 1 ]]; then printf '\r\033[K%s' "$now"; elif [[ $now != "$shown" ]]; then echo "$now"; fi
  shown=$now
  sleep 1
done
[[ ! -t 1 ]] || echo
await 'no more depth came' more_frames_than "$first"
echo "Summary: $(report)"
