# cmake -D PROGRAM=rgbd_tum -D PAGE=hullslam-rgbd_tum.1 -D HELP2MAN=... -D VERSION=... -P man_page.cmake
# Makes the manual page of a program. The name of the page is that of the installed program. The first
# line of --help says what it does. The settings of the build must not be in it, so the page does not
# depend on the computer.
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "^[^\n]*" summary "${help}")
get_filename_component(name ${PROGRAM} NAME)
get_filename_component(installed ${PAGE} NAME_WE)
get_filename_component(folder ${PAGE} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
execute_process(
  COMMAND ${HELP2MAN} --no-info --section=1 --source=HullSLAM --manual=HullSLAM
          --version-string=${VERSION} --name=${summary} --output=${PAGE}.part ${PROGRAM}
  COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PAGE}.part text)
string(TOUPPER ${name} upper)
string(TOUPPER ${installed} installed_upper)
string(REPLACE "TH ${upper}" "TH ${installed_upper}" text "${text}")
string(REPLACE "${name} \\-" "${installed} \\-" text "${text}")
string(REPLACE ".B ${name}\n" ".B ${installed}\n" text "${text}")
file(WRITE ${PAGE} "${text}")
file(REMOVE ${PAGE}.part)
