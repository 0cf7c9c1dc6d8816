#!/usr/bin/env bash
# Run a Python command whose extension module was built with AddressSanitizer and UBSan.
# The runtimes must be loaded first; Python's own allocator would hide errors, and its leaks at exit are not ours.
set -euo pipefail
compiler=${CXX:-c++}
export LD_PRELOAD="$("$compiler" -print-file-name=libasan.so) $("$compiler" -print-file-name=libstdc++.so)"
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export PYTHONMALLOC=malloc
exec "$@"
