#!/usr/bin/env bash
# Run a command as on a processor without vector instructions of the last ten years: other sums, other rounding.
#   tools/another_processor.sh PYTHON ARGUMENTS...
# What NumPy, OpenBLAS and the C library choose by the processor is restricted; the kernels are as compiled.
set -euo pipefail
NPY_DISABLE_CPU_FEATURES=$("$1" -c '
from numpy._core._multiarray_umath import __cpu_dispatch__ as chosen, __cpu_features__ as features
print(*(name for name in chosen if features[name]))')
export NPY_DISABLE_CPU_FEATURES
if [ "$(uname -m)" = x86_64 ]; then
    export OPENBLAS_CORETYPE=Nehalem GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-FMA4
fi
exec "$@"
