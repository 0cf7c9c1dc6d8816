# Sources of the shell engine.  The kernels are compiled once for each instruction set and chosen at run time.
set(shell_dir ${CMAKE_CURRENT_LIST_DIR})
target_sources(_kernels PRIVATE ${shell_dir}/bind.cpp ${shell_dir}/bind_model.cpp)

# apart from the binding, which nanobind compiles for size
add_library(shell_core OBJECT
  ${shell_dir}/model.cpp ${shell_dir}/lowering.cpp ${shell_dir}/thickness_rule.cpp ${shell_dir}/rigid_body.cpp
  ${shell_dir}/contact.cpp ${shell_dir}/contact_search.cpp ${shell_dir}/wall_contact.cpp ${shell_dir}/edge_contact.cpp
  ${shell_dir}/obstacles.cpp ${shell_dir}/body_contact.cpp ${shell_dir}/simulation.cpp ${shell_dir}/driven.cpp ${shell_dir}/stage.cpp
  ${shell_dir}/ledger.cpp ${shell_dir}/welds.cpp ${shell_dir}/isa.cpp ${shell_dir}/team.cpp)
set(shell_libraries shell_core)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(shell_isas v2 v3 v4)
else()
  set(shell_isas generic)
endif()
foreach(isa ${shell_isas})
  add_library(shell_${isa} OBJECT ${shell_dir}/kernel.cpp)
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
  target_compile_options(${library} PRIVATE -O3)
  target_link_libraries(${library} PRIVATE crumple_options)
  target_link_libraries(_kernels PRIVATE ${library})
endforeach()
