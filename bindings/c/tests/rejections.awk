# Turns the rejected calls of tests/data/rejections.jsonl into C: rejections.c defines a macro for
# each kind of call.
{
  match($0, /"call":"[a-z]+"/); call = substr($0, RSTART + 8, RLENGTH - 9)
  match($0, /"message":"[^"]*"/); message = substr($0, RSTART + 10, RLENGTH - 10)
  sub(/.*"(set|value)":/, ""); sub(/}*$/, ""); sub(/^{/, "")
  sub(/"mass2":{"Normal":\[/, "NORMAL, "); sub(/"mass2":{"Uniform":\[/, "UNIFORM, 0, 0, ")
  sub(/"mass2":{"LogUniform":\[/, "LOG_UNIFORM, 0, 0, "); sub(/\]$/, "")
  gsub(/"NaN"/, "NAN"); gsub(/"-inf"/, "-INF"); gsub(/"inf"/, "INF")
  gsub(/":/, " = "); if (call != "draw") gsub(/,/, "; " call "."); gsub(/"/, "")
  print call "_rejects(" message ", " (/ = / ? call "." : "") $0 ")"
}
