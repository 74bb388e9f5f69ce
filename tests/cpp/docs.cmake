# Writes the C and C++ of docs/c-and-cpp.md as programs into a folder, so that they are compiled. A block without #include
# is a part of one: it gets a solver and a mesh.
function(write_blocks markdown language folder files)
  file(READ "${markdown}" text)
  set(written "")
  set(number 0)
  while(TRUE)
    string(FIND "${text}" "\n```${language}\n" begin)
    if(begin EQUAL -1)
      break()
    endif()
    string(LENGTH "\n```${language}\n" fence)
    math(EXPR begin "${begin} + ${fence}")
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n```\n" end)
    string(SUBSTRING "${text}" 0 ${end} block)
    if(NOT block MATCHES "#include")
      string(CONCAT block "#include <shapeop.hpp>\n#include <iostream>\n\n"
        "static void part(shapeop::Solver &solver, std::vector<double> &points, std::vector<int> &faces, "
        "std::vector<int> &counts) {\n(void)solver, (void)points, (void)faces, (void)counts;\n{\n" "${block}"
        "\n}\n}\n\nint main() { (void)part; }")
    endif()
    math(EXPR number "${number} + 1")
    set(file "${folder}/${language}_block_${number}.${language}")
    file(WRITE "${file}" "${block}\n")
    list(APPEND written "${file}")
  endwhile()
  set(${files} "${written}" PARENT_SCOPE)
endfunction()
