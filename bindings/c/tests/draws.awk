# Turns the acrobots of tests/data/draws.csv that have a seed of their own into C.
BEGIN { FS = ","; print "static const float DRAWS[][9] = {" }
NR > 1 && $2 == "" { print "{" $1 ", " $3 ", " $4 ", " $5 ", " $6 ", " $7 ", " $8 ", " $9 ", " $10 "}," }
END { print "};" }
