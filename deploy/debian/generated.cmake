# What PROGRAM prints of itself in the form FORM (man, bash or zsh), as the file MADE.
get_filename_component(folder "${MADE}" DIRECTORY)
file(MAKE_DIRECTORY "${folder}")
execute_process(COMMAND "${PROGRAM}" --generate ${FORM} OUTPUT_FILE "${MADE}" COMMAND_ERROR_IS_FATAL ANY)
