# Builds the examples with a compiler and what pkg-config says, and runs them:
#
#     cmake -D SHAPEOP_PREFIX=/where/shapeop/is -D WORK=/an/empty/folder -P pkg_config.cmake
cmake_minimum_required(VERSION 3.15)

set(ENV{PKG_CONFIG_PATH} "${SHAPEOP_PREFIX}/lib/pkgconfig")
set(source "${CMAKE_CURRENT_LIST_DIR}/../..")

function(run output)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE complained
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT result EQUAL 0)
    string(REPLACE ";" " " line "${ARGN}")
    message(FATAL_ERROR "${line}: ${result}\n${said}\n${complained}")
  endif()
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

run(version pkg-config --modversion shapeop)
run(_ pkg-config --exists "shapeop >= ${version}")
run(flags pkg-config --cflags --libs shapeop)
run(libdir pkg-config --variable=libdir shapeop)
separate_arguments(flags UNIX_COMMAND "${flags}")
get_filename_component(resolved "${libdir}" ABSOLUTE)
if(NOT resolved STREQUAL "${SHAPEOP_PREFIX}/lib")
  message(FATAL_ERROR "libdir is ${libdir}, expected ${SHAPEOP_PREFIX}/lib")
endif()

set(cc "$ENV{CC}")
set(cxx "$ENV{CXX}")
if(NOT cc)
  set(cc cc)
endif()
if(NOT cxx)
  set(cxx c++)
endif()

set(examples "${source}/bindings/cpp/examples")
set(mesh "${source}/examples/meshes/hypar.obj")
run(_ ${cc} -std=c99 ${examples}/planarise.c ${flags} -Wl,-rpath,${libdir} -o ${WORK}/planarise_c)
run(_ ${cxx} -std=c++17 ${examples}/planarise.cpp ${flags} -Wl,-rpath,${libdir} -o ${WORK}/planarise)
run(said_c ${WORK}/planarise_c ${mesh} ${WORK}/c.obj)
run(said_cpp ${WORK}/planarise ${mesh} ${WORK}/cpp.obj)
foreach(said IN ITEMS said_c said_cpp)
  if(NOT ${said} MATCHES "the worst face is 0[.]")
    message(FATAL_ERROR "${said}: ${${said}}")
  endif()
endforeach()
message(STATUS "pkg-config: shapeop ${version}, ${flags}")
