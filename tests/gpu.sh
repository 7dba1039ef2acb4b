#!/usr/bin/env bash
# What can be shown on a machine with an NVIDIA GPU alone, in less than ten minutes.
#   tests/gpu.sh              builds for this machine's GPU, compares it with the processor, measures
#   tests/gpu.sh --pack DIR   builds for all GPUs and puts what is needed into DIR, for a machine that
#                             has neither our packages nor a compiler
#   tests/gpu.sh --use DIR    as the first, with what --pack has put into DIR
# The last lines are a table. Fails if anything differs; speed is not judged.
set -euo pipefail
here=$(pwd)
cd "$(dirname "$0")/.."

build() {  # the value of VS_CUDA_ARCHITECTURES
  cmake --preset gpu -B build/gpu-device -DVS_CUDA_ARCHITECTURES="$1" >/dev/null
  ninja -C build/gpu-device --quiet gpu_device_test gpu_bench
}

pack() {
  mkdir -p "$1/lib"
  cp build/gpu-device/tests/gpu/gpu_device_test build/gpu-device/tests/bench/gpu_bench "$1"
  # Without the loader and the C library, which every machine has.
  ldd "$1"/gpu_* | awk '$3 ~ "^/" { print $3 }' | sort -u |
    grep -vE '/(libc|libm|libdl|librt|libpthread)\.so' | xargs cp -Lt "$1/lib"
}

check() {  # folders of device test and benchmark
  local test=$1/gpu_device_test
  "$test" --gtest_brief=1
  local sanitizer
  sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda*/bin/compute-sanitizer 2>/dev/null | head -1 || true)
  if [[ $sanitizer ]]; then
    for tool in memcheck racecheck; do
      timeout 90 "$sanitizer" --tool $tool --error-exitcode 1 "$test" --gtest_brief=1 \
        --gtest_filter='Device.IsAMatcherByItsIndex:Device.MapsOutlive*'
    done
  else
    echo "no compute-sanitizer here: memory accesses are not checked"
  fi
  "$2/gpu_bench"
}

case ${1:-} in
  --pack)
    build "75;80;86;89;90;100;120"
    pack "$(cd "$here" && mkdir -p "$2" && cd "$2" && pwd)"
    ;;
  --use)
    dir=$(cd "$here" && cd "$2" && pwd)
    export LD_LIBRARY_PATH=$dir/lib
    check "$dir" "$dir"
    ;;
  "")
    build native
    check build/gpu-device/tests/gpu build/gpu-device/tests/bench
    ;;
  *)
    sed -n 2,7p "$0" | cut -c3-
    exit 2
    ;;
esac
