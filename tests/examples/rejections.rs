//! Bad arguments are rejected with a reason, before a file is written.

use super::{Folder, rejected};

/// Commands, and a part of the error message of each.
const REJECTED: &str = "\
energy_control --limit 0 => must be finite and above 0 N m
energy_control --episodes 0 => 0 is not in 1..
optimum search --width 0 => 0 is not in 1..
optimum search --file no/a.txt => a name that ends in .txt, in an existing folder
optimum table --file none.txt => error: none.txt:
phase_portrait --out a.png => a name that ends in .svg, in an existing folder
phase_portrait --out no/a.svg => a name that ends in .svg, in an existing folder
plan --depth 129 => 129 is not in 1..=128
plan --episodes 0 => 0 is not in 1..
plan --load none.bin => error: none.bin:
random_agent --seed 4x2 => got 'x' as character 2
random_agent --steps -1 => invalid value '-1' for '--steps
render_episode --state 1 => must be two numbers in rad
render_episode --state nan,1 => theta1 must be a finite number of rad, got NaN
render_episode --state 1,1 --out a.gif => --out must end in .png, got a.gif
render_episode --out a.png => --out must end in .gif, got a.png
render_episode --out no/a.gif => cannot write no/a.gif:
sutton1996 --runs 0 => 0 is not in 1..=10000
sutton1996 --episodes 1 => 1 is not in 2..=10000
sutton1996 --seed -1 => got '-' as character 1
sutton1996 --csv a.svg => must be a name that ends in .csv
sutton1996 --picture a.csv => must be a name that ends in .svg
sweep --episodes 0 => a multiple of the grid's 400 cells, from 400 to 400000000, got 0
sweep --episodes 1001 => from 400 to 400000000, got 1001
sweep --episodes 400000400 => from 400 to 400000000, got 400000400
sweep --seed -1 => got '-' as character 1
sweep --masses 1,0 => '0' for '--masses <KG>': must be finite and above 0 kg
sweep --masses 1e-60 => must be finite and above 0 kg in f32
sweep --torques inf,1 => must be finite and above 0 N m in f32
sweep --csv a.svg => must be a name that ends in .csv
sweep --picture a.csv => must be a name that ends in .svg
swing_up --memory 8k => must be 16k, 32k or 64k for the learner replay, got 8k
swing_up --seed -1 => got '-' as character 1
swing_up --load no/weights => error: no/weights:
swing_up --save no/weights => must be a file in an existing folder
swing_up --pictures no => must be an existing folder
trace --seed -5 => got '-' as character 1
trace --seed 1 --low -inf => low must be from -3.4e38 to
trace --seed 1 --low 0.2 => the lower reset bound must not be above the upper one, got 0.2 and 0.1
trace --seed 1 --dt 0 => dt must be finite and above 0 s, got 0
trace --seed 1 --dt 1e-60 --arithmetic fast => rounded to the arithmetic's f32, dt
";

#[test]
fn bad_arguments_are_rejected_before_a_file_is_written() {
    let folder = Folder::new();
    for line in REJECTED.lines() {
        let (command, reason) = line.split_once(" => ").unwrap();
        let errors = rejected(&mut folder.command(command));
        assert!(errors.contains(reason), "{command}: {errors}");
        assert!(folder.names().is_empty(), "{command}");
    }
}
