//! Prints how long plans take alone and side by side, s: without an iteration, and with eight.

#![forbid(unsafe_code)]

use acrobot::control::{Knot, Planner};
use acrobot::numpy::Pcg64;
use acrobot::{Fast, Params, State};
use cpu_time::ThreadTime;

fn main() {
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    let mut planner = Planner::<Fast>::new(params, 1.0).expect("the parameters are valid");
    let mut rng = Pcg64::new(0);
    let mut guesses = vec![vec![Knot::EMPTY; 100]; 160];
    for guess in &mut guesses {
        planner.guess(State::HANGING, &mut rng, guess).expect("the state is finite");
    }
    for (side_by_side, iterations) in [(false, 0), (false, 8), (true, 0), (true, 8)] {
        let mut plans = guesses.clone();
        let start = ThreadTime::now();
        if side_by_side {
            planner.improve_all(State::HANGING, iterations, &mut plans).expect("it is finite");
        } else {
            for plan in &mut plans {
                planner.improve(State::HANGING, iterations, plan).expect("the cost is finite");
            }
        }
        println!("{}", start.elapsed().as_secs_f64());
    }
}
