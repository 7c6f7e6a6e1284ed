# Installs SOURCE as DESTINATION (below the prefix), compressed so that the same text is the same file.
get_filename_component(folder "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${DESTINATION}" DIRECTORY)
file(MAKE_DIRECTORY "${folder}")
execute_process(COMMAND "${GZIP}" -9 -n -c "${SOURCE}" OUTPUT_FILE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${DESTINATION}"
                COMMAND_ERROR_IS_FATAL ANY)
file(CHMOD "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${DESTINATION}" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
