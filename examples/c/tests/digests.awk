# Turns digests in tests/bits/src/episodes.rs into C.
function literal(text) {
    match(text, /0x[0-9a-f_]+/)
    text = substr(text, RSTART, RLENGTH)
    gsub(/_/, "", text)
    return "UINT64_C(" text ")"
}
/^pub const SHARED_PARAMS:/ { print "static const uint64_t SHARED_PARAMS = " literal($0) ";" }
/^pub const FAST:/ { print "static const uint64_t FAST[] = {"; inside = 1; next }
inside && /^];/ { print "};"; inside = 0 }
inside { print "    " literal($0) "," }
