#!/usr/bin/env bash
# What can be shown on a machine with an NVIDIA GPU alone; meant to take less than ten minutes.
#   tests/gpu.sh              builds for this machine's GPU, compares it with the processor, measures
#   tests/gpu.sh --pack DIR   builds for all GPUs and puts what is needed into DIR, for a machine that
#                             has neither our packages nor a compiler
#   tests/gpu.sh --use DIR    as the first, with what --pack has put into DIR
#   tests/gpu.sh --kernels [sm_90]   registers, shared memory and spills of each kernel, as nvcc says;
#                             needs no GPU
# The last lines are a table. Fails, after all is measured, if anything differs; speed is not judged.
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
  local test=$1/gpu_device_test failed=()
  "$test" --gtest_brief=1 || failed+=("gpu_device_test")
  local sanitizer
  sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda*/bin/compute-sanitizer 2>/dev/null | head -1 || true)
  if [[ $sanitizer ]]; then
    for tool in memcheck racecheck initcheck synccheck; do
      timeout 60 "$sanitizer" --tool $tool --error-exitcode 1 "$test" --gtest_brief=1 \
        --gtest_filter='Device.IsAMatcherByItsIndex:Device.MapsOutlive*:Device.EqualsTheReferenceOnSmall*' ||
        failed+=("$tool ($?; 124: not done in a minute)")
    done
  else
    echo "no compute-sanitizer here: memory accesses are not checked"
  fi
  "$2/gpu_bench" || failed+=("gpu_bench")
  ((${#failed[@]} == 0)) || { printf 'FAILED: %s\n' "${failed[@]}"; exit 1; }
}

kernels() {  # an architecture
  nvcc -std=c++20 -O3 -I. -arch="$1" --expt-relaxed-constexpr -diag-suppress=2810 --resource-usage \
    -cubin gpu/cuda_executor.cu -o /dev/null 2>&1 | c++filt | awk '
    /Compiling entry function/ { sub(/.*entry function ./, ""); sub(/\(vs::gpu::Frame.*|. for .*/, "")
                                 gsub(/void |vs::gpu::|\(anonymous namespace\)::/, ""); name = $0 }
    /spill stores/ { spilled = $5 + $9 }
    / Used [0-9]+ registers/ { shared = match($0, /[0-9]+ bytes smem/) ? substr($0, RSTART) + 0 : 0
      match($0, /Used [0-9]+/); registers = substr($0, RSTART + 5) + 0
      printf "%-60s %3d registers %6d B shared %4d B spilled\n", name, registers, shared, spilled }' | sort
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
  --kernels)
    kernels "${2:-sm_90}"
    ;;
  "")
    build native
    check build/gpu-device/tests/gpu build/gpu-device/tests/bench
    ;;
  *)
    sed -n 2,9p "$0" | cut -c3-
    exit 2
    ;;
esac
