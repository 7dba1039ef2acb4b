#!/usr/bin/env bash
# Runs VisionServer with a simulated pair of GigE Vision cameras: installs what is missing, builds,
# starts cameras and server, and says where to look.
#
#   deploy/run.sh [--duration SECONDS] [--fps N] [--port N] [--folder DIR] [--data DIR]
#
#   --duration SECONDS  end by itself after so many seconds of depth; without it, Ctrl-C ends it
#   --fps N             pairs per second that the cameras are triggered for (default 10)
#   --port N            where the server listens on this machine (default 50051; 0: any free port)
#   --folder DIR        serve the picture pairs of a folder in place of the simulated scene
#   --data DIR          what the server stores (default: ~/.local/state/visionserver-demo)
#
# Exit code 0 only if depth was streamed.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; }
die() { printf 'run.sh: %s\n' "$*" >&2; exit "${code:-1}"; }
number() { [[ $2 =~ ^[0-9]+([.][0-9]+)?$ ]] || code=2 die "$1 needs a number, not \"$2\""; }

duration='' fps=10 port=50051 folder='' data=${XDG_STATE_HOME:-$HOME/.local/state}/visionserver-demo
while (($#)); do
  case $1 in
    --duration | --fps | --port | --folder | --data)
      (($# > 1)) || code=2 die "$1 needs a value; see --help"
      printf -v "${1#--}" %s "$2"
      shift 2 ;;
    --help | -h) usage; exit ;;
    *) code=2 die "unknown option $1; see --help" ;;
  esac
done
[[ -z $duration ]] || number --duration "$duration"
number --fps "$fps"
number --port "$port"

deploy/prepare.sh
bin=$PWD/build/release/bin

# What we start is ours to end, whatever happens.
children=()
work=$(mktemp -d)
finish() {
  trap - EXIT INT TERM
  ((${#children[@]} == 0)) || kill "${children[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Waits until `file` has a line that matches; ends with the reason when process `pid` has ended.
await() { # file pattern pid what
  until grep -qE "$2" "$1"; do
    kill -0 "$3" 2>/dev/null || die "$4 ended: $(tail -n 3 "$1" "$1.err" 2>/dev/null)"
    sleep 0.1
  done
}

mkdir -p "$data"/{sequences,rigs}
chmod 700 "$data"
[[ -e $data/sequences/stereo_depth.json ]] || cp deploy/demo/stereo_depth.json "$data/sequences/"
[[ -e $data/rigs/demo.json ]] || cp deploy/demo/rig.json "$data/rigs/demo.json"
sed "s|@DATA@|$data|; s|@PORT@|$port|" deploy/demo/server.conf >"$work/server.conf"

"$bin/gevsim" --fps "$fps" ${folder:+--folder "$folder"} \
  >"$work/cameras" 2>"$work/cameras.err" &
children+=($!)
await "$work/cameras" '^gevsim ready' $! 'the simulated rig'

"$bin/visionserver" --config "$work/server.conf" --report 1 \
  >"$work/server" 2>"$work/server.err" &
server=$!
children+=("$server")
await "$work/server" '^stereo_depth: [0-9.]+ fps' "$server" 'the server'

address=$(sed -n 's/^VisionServer .* listens on \([^ ]*\).*/\1/p' "$work/server")
fingerprint=$(sed -n 's/^certificate fingerprint (SHA-256): //p' "$work/server")
password=$(sed -n 's/^one-time password of the user admin.*: //p' "$work/server")
rate() { sed -n 's/^stereo_depth: \([0-9.]* fps\).*/\1/p' "$work/server" | tail -n 1; }

cat <<TEXT

VisionServer streams depth from two simulated GigE cameras: $(rate)

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
shown=''
while kill -0 "$server" 2>/dev/null; do
  if [[ -n $duration ]] && ((SECONDS - started >= ${duration%.*})); then break; fi
  now=$(grep -E '^stereo_depth: ' "$work/server" | tail -n 1)
  if [[ -t 1 ]]; then printf '\r\033[K%s' "$now"; elif [[ $now != "$shown" ]]; then echo "$now"; fi
  shown=$now
  sleep 1
done
[[ -t 1 ]] && echo
kill -0 "$server" 2>/dev/null || die "the server ended: $(tail -n 3 "$work/server.err")"

echo "Summary: $(grep -E '^stereo_depth: ' "$work/server" | tail -n 1)"
