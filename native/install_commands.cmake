# SPDX-License-Identifier: GPL-3.0-or-later
# What the build needs, and how this system installs it.

# The one of these commands that is for this system: Debian's, Fedora's, Arch's, that of a Mac and that of Windows; all
# where it is none of these. os_release: the file that names the system where there is one.
function(lsgp_command_of_system os_release command debian fedora arch mac windows)
  set(systems "")
  if(EXISTS ${os_release})
    file(STRINGS ${os_release} systems REGEX "^ID(_LIKE)?=")
  endif()
  if(systems MATCHES "debian|ubuntu")
    set(found ${debian})
  elseif(systems MATCHES "fedora|rhel")
    set(found ${fedora})
  elseif(systems MATCHES "arch")
    set(found ${arch})
  elseif(CMAKE_HOST_APPLE)
    set(found ${mac})
  elseif(CMAKE_HOST_WIN32)
    set(found ${windows})
  else()
    set(found "one of: ${debian}; ${fedora}; ${arch}; ${mac}; ${windows}")
  endif()
  set(${command} "${found}" PARENT_SCOPE)
endfunction()

# An error that says what installs a compiler, before CMake says that there is none. Other systems than Unix and tools
# that compile for another one know where theirs is.
function(lsgp_require_compiler)
  if(DEFINED CMAKE_CXX_COMPILER OR NOT CMAKE_HOST_UNIX OR CMAKE_TOOLCHAIN_FILE OR DEFINED ENV{CMAKE_TOOLCHAIN_FILE})
    return()
  endif()
  set(names c++ CC g++ aCC xlC icpx icpc clang++)  # what CMake looks for
  if(DEFINED ENV{CXX})
    separate_arguments(words UNIX_COMMAND "$ENV{CXX}")
    list(GET words 0 names)
  endif()
  find_program(LSGP_COMPILER NAMES ${names})
  mark_as_advanced(LSGP_COMPILER)
  if(NOT LSGP_COMPILER)
    lsgp_command_of_system(/etc/os-release command "apt-get install g++" "dnf install gcc-c++" "pacman -S gcc"
      "xcode-select --install" "Visual Studio's installer")
    list(JOIN names ", " names)
    message(FATAL_ERROR "A C++ compiler is needed to build lsgp, and there is none here (${names}).\n"
                        "This installs one:\n  ${command}\n")
  endif()
endfunction()

# An error that says what installs Python's headers, after a search for Python in which they were missing; CMake's own
# where there is no interpreter either.
function(lsgp_require_python_headers)
  if(Python_FOUND)
    return()
  endif()
  find_package(Python COMPONENTS Interpreter REQUIRED)
  lsgp_command_of_system(/etc/os-release command "apt-get install python3-dev" "dnf install python3-devel"
    "pacman -S python" "brew install python" "Python's installer")
  message(FATAL_ERROR "The headers of Python (Python.h) are needed to build its module, and they are not installed.\n"
                      "This installs them for the system's own Python:\n  ${command}\n")
endfunction()
