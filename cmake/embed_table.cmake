# Run by ensemble_embed_table: writes HEADER with names and texts of FILES (separated by '|') as an array of pairs.
string(REPLACE "|" ";" FILES "${FILES}")
set(rows "")
foreach(file ${FILES})
  file(READ ${file} text)
  get_filename_component(name ${file} NAME_WE)
  string(APPEND rows "    {\"${name}\", R\"__(${text})__\"},\n")
endforeach()
file(WRITE ${HEADER}
  "#pragma once\n#include <string_view>\n#include <utility>\nnamespace ensemble {\n"
  "inline constexpr std::pair<std::string_view, std::string_view> ${SYMBOL}[] = {\n${rows}};\n}\n")
