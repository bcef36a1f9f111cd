# Turns the calls of tests/data/results.jsonl into C: the arguments and the result become constants,
# and results.c defines a macro for each call that uses them. C computes in the arithmetic `fast`.
/"arithmetic":"portable"/ { next }
{
  match($0, /"call":"[a-z_]+"/); call = substr($0, RSTART + 8, RLENGTH - 9)
  print "{"
  gsub(/"(call|arithmetic)":"[a-z_]*",?/, ""); gsub(/[{}]/, "")
  n = split($0, field, /,?"/)
  for (i = 2; i < n; i += 2) {
    name = field[i]; value = substr(field[i + 1], 2)
    if (value ~ /^\[/) {
      gsub(/\[/, "{", value); gsub(/\]/, "}", value)
      print "    static const double " name "[] = " value ";"
    } else {
      print "    const double " name " = " value ";"
    }
  }
  print "    begin(\"" call "\", result, COUNT(result));\n    " call "();\n    end();\n}"
}
