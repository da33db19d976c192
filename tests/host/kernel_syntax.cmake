# Compiles one kernel file with clang, without code generation, once for each code path that the processor's
# features choose (simd.h). A header is compiled alone: it has to include what it uses.
# Usage: cmake -DCLANG=<clang> -DROOT=<repository> -DFILE=kernels/<file> -DTARGETS=<-march values> -P kernel_syntax.cmake

if(FILE MATCHES "\\.h$")
    set(input -include ${FILE} /dev/null)
else()
    set(input ${FILE})
endif()
string(REPLACE "," ";" TARGETS "${TARGETS}")
foreach(target IN LISTS TARGETS)
    # clang leaves __OPENCL_VERSION__ to the OpenCL driver; the engine defines SAHL_RAYS_PER_ITEM.
    execute_process(
        COMMAND ${CLANG} -x cl -cl-std=CL1.2 -fsyntax-only -Xclang -finclude-default-header -Wall -Wextra -Werror
                -march=${target} -D__OPENCL_VERSION__=120 -DSAHL_RAYS_PER_ITEM=64 -I. ${input}
        WORKING_DIRECTORY ${ROOT}
        RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${FILE} does not compile for -march=${target}")
    endif()
endforeach()
