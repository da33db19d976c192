# Installs the engine into an empty folder, builds the consumer against it alone, runs it, checks what it prints.
# Usage: cmake -DSAHL_BUILD= -DCONSUMER= -DWORK= -DGENERATOR= -DCOMPILER= -DBUILD_TYPE= -P check.cmake

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build)
execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${SAHL_BUILD} --prefix ${WORK}/prefix
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
            -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/build/consumer OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
set(expected "centre 0.5 0.25 1\ncorner 0.125 0.25 0.5\n")
if(NOT printed STREQUAL expected)
    message(FATAL_ERROR "The consumer printed\n${printed}where this was expected:\n${expected}")
endif()
