# The one warnings target; everything of ours links it PRIVATE.
add_library(ensemble_warnings INTERFACE)
target_compile_options(ensemble_warnings INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 warns wrongly of std::string's operator+ (GCC bug 105651)
  $<$<BOOL:${ENSEMBLE_WERROR}>:-Werror>)

# Floating point must give the same bits on every machine: no contraction into fused operations.
add_compile_options(-ffp-contract=off)

if(ENSEMBLE_SANITIZE)
  # Instrumented code makes GCC 12 warn wrongly, inside <regex> among others.
  target_compile_options(ensemble_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${ENSEMBLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${ENSEMBLE_SANITIZE})
endif()

# A static library of ours: ensemble_library(NAME source...).
function(ensemble_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR} PRIVATE ${PROJECT_BINARY_DIR})
  target_link_libraries(${name} PRIVATE ensemble_warnings)
endfunction()
