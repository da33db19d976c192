# Installs Sahl into an empty folder, checks completion and manual page, builds the consumer against it alone,
# runs it, checks what it prints, reads the image that it writes.
# Usage: cmake -DSAHL_BUILD= -DCONSUMER= -DWORK= -DGENERATOR= -DCOMPILER= -DBUILD_TYPE= -P check.cmake

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build)
execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${SAHL_BUILD} --prefix ${WORK}/prefix
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# What the program prints about itself lies where shells and man look for it.
function(check_document path)
    execute_process(COMMAND ${WORK}/prefix/bin/sahl ${ARGN} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
    file(READ ${WORK}/prefix/share/${path} installed)
    if(printed STREQUAL "" OR NOT printed STREQUAL installed)
        message(FATAL_ERROR "share/${path} is not what 'sahl ${ARGN}' prints")
    endif()
endfunction()
check_document(bash-completion/completions/sahl completion bash)
check_document(zsh/site-functions/_sahl completion zsh)
check_document(man/man1/sahl.1 man)

execute_process(
    COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${CONSUMER} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
            -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/build/consumer WORKING_DIRECTORY ${WORK}/build OUTPUT_VARIABLE printed
    COMMAND_ERROR_IS_FATAL ANY)
set(expected "centre 0.5 0.25 1\ncorner 0.125 0.25 0.5\n")
if(NOT printed STREQUAL expected)
    message(FATAL_ERROR "The consumer printed\n${printed}where this was expected:\n${expected}")
endif()
# Both with the library of image codecs that is installed.
execute_process(COMMAND ${WORK}/prefix/bin/sahl compare image.png image.png WORKING_DIRECTORY ${WORK}/build
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
