# Reads acrobot.h and writes, for misuse.c, a call of each function with pointers of an array `p`,
# and a table of what they point to: arguments, and after a struct of pointers its members.
BEGIN {
  arrays = "^(actions|bytes|final_observations|gains|improved|knots|mask|models|observations|" \
    "plan|rewards|samples|seeds|terminated|torques|truncated)$"
  # No arrays, but they must not overlap others either.
  apart = "^(controller|cost_to_go|results|seed)$"
  optional = "[.](error|options)$|_reset.*[.]observation$|options_t[.]|results_t[.].*observations$"
  holders["memory_t"] = 1
}
{ sub(/ *\/\/.*/, "") }
/^typedef struct/ { fields = "" }
/^  [^ ].*;$/ { fields = fields $0 }
/^} acrobot_/ {
  type = substr($2, 1, length($2) - 1)
  if (fields ~ /bytes\[ACROBOT/) holders[type] = 1
  if (fields ~ /[*]/) members[type] = fields
}
/^#if.*(__wasm__|ACROBOT_INSTRUMENTS)/ || /^#endif/ && guarded { guarded = !guarded; print; table = table $0 "\n" }
/^acrobot_status_t/ { owner = $2; sub(/[(].*/, "", owner) }
owner { text = text $0 }
owner && /[)];$/ {
  slots = 0
  init = -1
  rows = ""
  call = arguments(text)
  print "static acrobot_status_t on_" owner "(void **p)\n{\n    return " owner "(" call ");\n}"
  table = table "    {\"" owner "\", on_" owner ", " init ", {" rows "}},\n"
  functions++
  owner = text = ""
}
END {
  print "static const struct function TABLE[] = {\n" table "};"
  print "enum { BATCH = " inits["memory_t"] " };"
}

function arguments(text, list, n, i, call) {
  gsub(/^[^(]*[(]|[)];$/, "", text)
  n = split(text, list, /, */)
  for (i = 1; i <= n; i++) call = call (i > 1 ? ", " : "") argument(list[i])
  return call
}

# Adds a row, and returns the argument in C.
function argument(text, at, is_const, name, type, pointed, kind, good, list, n, i) {
  at = slots
  sub(/^ +/, "", text)
  is_const = sub(/^const /, "", text)
  name = text
  gsub(/.*[ *]|[)]?(\[.*)?$/, "", name)
  type = text
  if (!sub("[*]" name, "*", type)) return number(substr(text, 1, index(text, " ") - 1), name)
  pointed = type
  sub(/ ?[(][*][)]| ?[*]$/, "", pointed)
  if (at == 0 && pointed ~ /^(void|acrobot_batch_t)$/) pointed = "memory_t"
  kind = pointed in members ? "STRUCT" : is_const || pointed in holders ? "INPUT" : "OUTPUT"
  good = "a_" (pointed ~ /^acrobot/ ? substr(pointed, 9, length(pointed) - 10) : name)
  if (at == 0 && pointed in holders) {
    if (!(pointed in inits)) inits[pointed] = functions + 0
    init = inits[pointed]
    kind = owner ~ /_init|_load/ ? "MADE" : "HOLDER"
  }
  add(kind, name, pointed, kind == "INPUT" ? good : kind == "OUTPUT" ? "outputs[" at "]" : \
    kind == "STRUCT" ? "&pointers[" at + 1 "]" : "arena + MARGIN")
  if (kind == "STRUCT") {
    n = split(members[pointed], list, /;/)
    text = owner
    owner = pointed
    for (i = 1; i < n; i++) argument(list[i])
    owner = text
  }
  return "(" (is_const ? "const " : "") type ")p[" at "]"
}

function number(type, name, good) {
  if (type ~ /^(float|double|int)$/) good = "a_" type
  if (name == "index" || name == "count" && owner ~ /_batch_/) good = "a_" name
  if (good) {
    add("NUMBER", name, type, good)
    return "*(" type " *)p[" slots - 1 "]"
  }
  # A member has a place.
  if (owner ~ /_t$/) add("NONE", name, type, "(void *)1")
  if (name == "length" && rows ~ /bytes/) return "saved"
  return name ~ /^(count|length)$/ ? "COUNT" : name == "size" ? "SIZE" : 1
}

function add(kind, name, type, good, count) {
  count = name == "bytes" ? "SIZE" : name ~ arrays ? "COUNT" : 1
  if (good ~ /^a_/ && !(good in declared)) {
    declared[good] = 1
    print "static " type " " good "[" (count == "SIZE" ? count : type in holders ? 1 : "COUNT") "];"
  }
  rows = rows "\n        ARGUMENT(" kind ", " name ", " type ", " count ", " \
    (count != 1 || name ~ apart) ", " ((owner "." name) ~ optional) ", " good "),"
  slots++
}
