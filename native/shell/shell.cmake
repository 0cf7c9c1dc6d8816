# Sources of the shell engine.  The kernels are compiled once for each instruction set and chosen at run time.
set(native ${CMAKE_CURRENT_SOURCE_DIR}/native)
target_sources(_kernels PRIVATE ${native}/shell/bind/bind.cpp ${native}/shell/bind/bind_model.cpp)

# apart from the binding, which nanobind compiles for size
add_library(shell_core OBJECT
  ${native}/shell/run/model.cpp ${native}/shell/run/lowering.cpp ${native}/shell/element/thickness_rule.cpp ${native}/shell/rigid/rigid_body.cpp
  ${native}/shell/contact/contact.cpp ${native}/shell/contact/contact_search.cpp ${native}/shell/contact/wall_contact.cpp ${native}/shell/contact/edge_contact.cpp
  ${native}/shell/contact/obstacles.cpp ${native}/shell/contact/body_contact.cpp ${native}/shell/run/simulation.cpp ${native}/shell/rigid/driven.cpp ${native}/shell/run/stage.cpp
  ${native}/shell/run/ledger.cpp ${native}/shell/rigid/welds.cpp ${native}/shell/simd/isa.cpp ${native}/common/machine.cpp ${native}/common/team.cpp)
set(shell_libraries shell_core)

# by the compiler's own word: CMAKE_SYSTEM_PROCESSOR is the machine that builds, not the one that is built for
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#if !defined(__x86_64__)
#error
#endif
int main() { return 0; }" CRUMPLE_FOR_X86_64)
if(CRUMPLE_FOR_X86_64)
  set(shell_isas v2 v3 v4)
else()
  set(shell_isas generic)
endif()
foreach(isa ${shell_isas})
  add_library(shell_${isa} OBJECT ${native}/shell/element/kernel.cpp)
  target_compile_options(shell_${isa} PRIVATE -Wno-psabi)
  if(isa STREQUAL v4 AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC 12 warns of its own AVX-512 header: _mm512_undefined_* reads a variable that is meant to be undefined
    target_compile_options(shell_${isa} PRIVATE -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
  if(isa STREQUAL generic)
    target_compile_definitions(shell_${isa} PRIVATE CRUMPLE_KERNELS=kernels_generic CRUMPLE_KERNELS_NAME="generic")
  else()
    target_compile_options(shell_${isa} PRIVATE -march=x86-64-${isa})
    target_compile_definitions(shell_${isa} PRIVATE CRUMPLE_KERNELS=kernels_${isa} CRUMPLE_KERNELS_NAME="x86-64-${isa}")
  endif()
  list(APPEND shell_libraries shell_${isa})
endforeach()
foreach(library ${shell_libraries})
  set_target_properties(${library} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
  target_compile_options(${library} PRIVATE ${gnu}-O3)
  target_include_directories(${library} PRIVATE ${native})
  target_link_libraries(${library} PRIVATE crumple_options)
  target_link_libraries(_kernels PRIVATE ${library})
endforeach()
