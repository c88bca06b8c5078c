# SPDX-License-Identifier: GPL-3.0-or-later
# Eigen and Spectra, which consist of headers: the system's, those of Python packages, or downloaded.
include(${CMAKE_CURRENT_LIST_DIR}/install_commands.cmake)

# Downloads archive `name` from the first of the addresses that follow which has it, and unpacks it. folder: where to.
# failure: empty, or a line about every address that failed. What was unpacked before is not downloaded again.
function(lsgp_download name digest folder failure)
  set(reasons "")
  if(NOT EXISTS ${folder})
    file(REMOVE_RECURSE ${folder}.new)
    foreach(address IN LISTS ARGN)
      message(STATUS "Downloading ${name} from ${address}")
      file(DOWNLOAD ${address} ${folder}.archive STATUS status INACTIVITY_TIMEOUT 20)
      list(GET status 0 code)
      list(GET status 1 reason)
      if(code EQUAL 0)
        file(SHA256 ${folder}.archive found)
        if(found STREQUAL digest)
          file(ARCHIVE_EXTRACT INPUT ${folder}.archive DESTINATION ${folder}.new)
          file(REMOVE ${folder}.archive)
          file(RENAME ${folder}.new ${folder})
          set(reasons "")
          break()
        endif()
        set(reason "its SHA-256 is ${found}, and not ${digest}")
      endif()
      file(REMOVE ${folder}.archive)
      string(APPEND reasons "  ${address}: ${reason}\n")
    endforeach()
  endif()
  set(${failure} "${reasons}" PARENT_SCOPE)
endfunction()

# The one command that installs both libraries here. os_release: the file that names the system where there is one.
function(lsgp_install_command os_release command)
  lsgp_command_of_system("${os_release}" found
    "apt-get install libeigen3-dev libspectra-dev"
    "dnf install eigen3-devel spectra-devel"
    "git clone https://aur.archlinux.org/spectra.git && (cd spectra && makepkg -si)"
    "brew install eigen spectra"
    "vcpkg install eigen3 spectra, and name vcpkg's toolchain in CMAKE_TOOLCHAIN_FILE")
  set(${command} "${found}" PARENT_SCOPE)
endfunction()

# Defines `target` with the headers of a library that is downloaded; an error where it cannot be. include: their folder
# in the archive.
function(lsgp_download_headers name target digest include)
  string(REPLACE " " "-" folder "${name}")
  set(folder ${PROJECT_BINARY_DIR}/headers/${folder})
  if(LSGP_FETCH)
    lsgp_download("${name}" ${digest} ${folder} failure ${ARGN})
    set(failure "and could not be downloaded:\n${failure}")
  else()
    set(failure "and LSGP_FETCH is off.\n")
  endif()
  if(NOT IS_DIRECTORY ${folder}/${include})
    lsgp_install_command(/etc/os-release command)
    message(FATAL_ERROR "Eigen 3.4 and Spectra 1.0 or newer are needed. ${name} is not installed, ${failure}"
                        "This installs both:\n  ${command}\n")
  endif()
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} INTERFACE ${folder}/${include})
endfunction()

# Sets up the targets Eigen3::Eigen and Spectra::Spectra. GitLab and GitHub make archives of a tag on request, whose bytes
# may change some day; the public archive of Debian keeps those of the releases, with the digests given here.
macro(lsgp_find_header_libraries)
  list(APPEND CMAKE_PREFIX_PATH $ENV{CMEEL_PREFIX})
  find_package(Eigen3 5 QUIET NO_MODULE)
  if(NOT TARGET Eigen3::Eigen)
    find_package(Eigen3 3.4 QUIET NO_MODULE)
  endif()
  include(CMakeFindDependencyMacro)  # Spectra 1.0's package file needs it
  find_package(Spectra 1 QUIET NO_MODULE)
  if(NOT TARGET Spectra::Spectra)
    find_path(LSGP_SPECTRA Spectra/SymGEigsShiftSolver.h)  # its package is not found where Eigen's is not
    if(LSGP_SPECTRA)
      add_library(Spectra::Spectra INTERFACE IMPORTED GLOBAL)
      target_include_directories(Spectra::Spectra INTERFACE ${LSGP_SPECTRA})
    endif()
  endif()
  if(NOT TARGET Eigen3::Eigen)
    lsgp_download_headers("Eigen 3.4.0" Eigen3::Eigen
      b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626 eigen-3.4.0
      https://gitlab.com/libeigen/eigen/-/archive/3.4.0/eigen-3.4.0.tar.bz2
      http://deb.debian.org/debian/pool/main/e/eigen3/eigen3_3.4.0.orig.tar.bz2)
  endif()
  if(NOT TARGET Spectra::Spectra)
    lsgp_download_headers("Spectra 1.0.1" Spectra::Spectra
      919e3fbc8c539a321fd5a0766966922b7637cc52eb50a969241a997c733789f3 spectra-1.0.1/include
      https://github.com/yixuan/spectra/archive/refs/tags/v1.0.1.tar.gz
      http://deb.debian.org/debian/pool/main/s/spectra/spectra_1.0.1.orig.tar.gz)
  endif()
endmacro()
