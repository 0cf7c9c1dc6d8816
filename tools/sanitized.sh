#!/usr/bin/env bash
# Run a Python command whose extension module was built with sanitizers: `tools/sanitized.sh address|thread COMMAND`.
# The runtimes must be loaded first; Python's own allocator would hide errors, and its leaks at exit are not ours.
set -euo pipefail
compiler=${CXX:-c++}
case $1 in
    address) runtime=libasan.so ;;
    thread) runtime=libtsan.so ;;
    *) echo "$0: unknown sanitizer $1; address or thread is allowed" >&2; exit 2 ;;
esac
shift
export LD_PRELOAD="$("$compiler" -print-file-name=$runtime) $("$compiler" -print-file-name=libstdc++.so)"
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1
export PYTHONMALLOC=malloc
exec "$@"
