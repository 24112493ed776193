#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the decoder of the page as WebAssembly, by Debian's clang: build.sh [FILE]
set -euo pipefail
cd "$(dirname "$0")/../../.."
to=$(realpath -m "${1:-ext/web/decoder/lidar_decoder.wasm}")
objects=$(mktemp -d)
trap 'rm -rf "$objects"' EXIT

mkdir -p "$objects/src/codec"
template=$(<src/codec/mixing/start_table.h.in)
echo "${template/@TABLE@/$(<src/codec/mixing/start_table.txt)}" > "$objects/src/codec/start_table.h"

# The gzipped module is smaller than 300 kB. For this, functions are inlined only where that makes
# the code smaller, and large tables are computed when the module starts.
#
# The files in `fast` have loops over bits and points. All other files are compiled for size. Files
# that end with _encoder.cpp are not compiled.
fast=(src/cloud/range_projection src/codec/mixing/{binary_coder,mixing_codec,slice_coder}
  src/codec/rans/{adaptive_coder,blended_coder,blended_mask,mask_coder,predictor,rans} src/codec/cloud/{beam_part,cell_tree,level_tree,pixel_part})
small=(src/cloud/{point_fields,sensor_model} ext/web/decoder/{crc,decoder})
for file in src/codec/*.cpp src/codec/{rans,mixing,cloud}/*.cpp; do
  case " ${fast[*]} $file" in *" ${file%.cpp} "* | *_encoder.cpp) ;; *) small+=("${file%.cpp}") ;; esac
done
flags=(--target=wasm32-wasi -msimd128 -std=c++17 -fno-exceptions -fno-rtti -DNDEBUG -ffp-contract=off
  -fconstexpr-steps=30000 -fvisibility=hidden -ffunction-sections -fdata-sections -I. "-I$objects")
compile() { printf '%s\n' "${@:2}" | xargs -P 2 -I{} sh -c "clang++ ${flags[*]} $1 -c {}.cpp -o $objects/\$(echo {} | tr / _).o"; }
compile '-O2 -mllvm -inline-threshold=10' "${fast[@]}"
compile -Oz "${small[@]}"
# The stack is placed before all other memory, so that an overflow of the stack traps.
clang++ "${flags[@]}" -mexec-model=reactor -Wl,-z,stack-size=1048576,--stack-first,--strip-all,--gc-sections \
  -Wl,--max-memory=536870912 "$objects"/*.o -o "$to"
