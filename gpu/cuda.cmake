# Finds CUDA and enables its language, for the whole tree, or sets VS_HAS_CUDA to OFF.
set(VS_WITH_CUDA AUTO CACHE STRING
    "The matcher \"cuda\": AUTO where a CUDA compiler >= 12 is found, ON or an error, OFF")
set_property(CACHE VS_WITH_CUDA PROPERTY STRINGS AUTO ON OFF)
set(VS_HAS_CUDA OFF)
if(VS_WITH_CUDA STREQUAL "OFF")
  return()
endif()

# Often installed without being on the PATH.
if(EXISTS "$ENV{CUDACXX}")
  set(VS_NVCC "$ENV{CUDACXX}" CACHE FILEPATH "The CUDA compiler")
endif()
find_program(VS_NVCC nvcc HINTS $ENV{CUDA_PATH}/bin PATHS /usr/local/cuda/bin)
set(vs_nvcc_version 0)
if(VS_NVCC)
  execute_process(COMMAND ${VS_NVCC} --version OUTPUT_VARIABLE vs_nvcc_says)
  string(REGEX MATCH "release ([0-9.]+)" vs_matched "${vs_nvcc_says}")
  set(vs_nvcc_version "${CMAKE_MATCH_1}")
endif()
if(vs_nvcc_version VERSION_LESS 12)
  if(VS_WITH_CUDA STREQUAL "ON")
    message(FATAL_ERROR "VS_WITH_CUDA is ON, but there is no CUDA compiler (nvcc) of version 12 or "
                        "newer; found: \"${VS_NVCC}\". Put nvcc on the PATH or set CUDACXX.")
  endif()
  message(STATUS "No CUDA compiler (nvcc >= 12): built without the matcher \"cuda\"")
  return()
endif()

# One kind of machine code each, and PTX of the last for GPUs to come.
set(vs_all_architectures 75 80 86 89 90)
if(vs_nvcc_version VERSION_GREATER_EQUAL 12.8)
  list(APPEND vs_all_architectures 100 120)
endif()
set(VS_CUDA_ARCHITECTURES "${vs_all_architectures}" CACHE STRING
    "Compute capabilities of the GPUs to build for, without the dot, ascending; or native")
set(CMAKE_CUDA_ARCHITECTURES ${VS_CUDA_ARCHITECTURES})
list(POP_BACK CMAKE_CUDA_ARCHITECTURES vs_last)
list(TRANSFORM CMAKE_CUDA_ARCHITECTURES APPEND -real)
list(APPEND CMAKE_CUDA_ARCHITECTURES ${vs_last})

set(CMAKE_CUDA_RUNTIME_LIBRARY Static)  # so that the programs start where there is no CUDA
set(ENV{CUDACXX} ${VS_NVCC})
if(VS_WITH_CUDA STREQUAL "AUTO")
  # A compiler that does not get along with the host's, or half a toolkit, is as good as none.
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    find_package(CUDAToolkit QUIET)
  endif()
  if(NOT CUDAToolkit_FOUND)
    message(STATUS "${VS_NVCC} does not work here: built without the matcher \"cuda\"")
    return()
  endif()
endif()
enable_language(CUDA)
# CMake 3.25 does not know that nvcc knows C++20.
if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
endif()
find_package(CUDAToolkit REQUIRED)
set(VS_HAS_CUDA ON)
# `threads`: the kinds of machine code are made side by side. nvcc's warning 2810 takes assignments for
# ignored results; the host's compiler sees the true ones. Kernels call constexpr functions.
add_compile_options(
  "$<$<COMPILE_LANGUAGE:CUDA>:--threads=2;--expt-relaxed-constexpr;-Werror=all-warnings;-diag-suppress=2810>"
  "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wshadow,-Werror,-Wno-missing-field-initializers>")
