# Turns digests in tests/bits/src/episodes.rs into C.
/^pub const (BATCHES|FAST):/ {
  sub(/:/, "", $3); print "static const uint64_t " $3 "[] = {"; inside = 1; next
}
inside && /^];/ { print "};"; inside = 0 }
inside { gsub(/_/, ""); print }
