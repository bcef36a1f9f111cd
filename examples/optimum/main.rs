use std::time::Instant;
use acrobot::Acrobot;
use acrobot::arithmetic::Reference;
use rayon::prelude::*;
mod beam;
mod values;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let get = |i: usize, d: f32| args.get(i).map_or(d, |x| x.parse().unwrap());
    let t = Instant::now();
    let values = values::Values::compute().unwrap();
    eprintln!("values {:?}", t.elapsed());
    let hang = values.at(&acrobot::State::default());
    eprintln!("hanging {hang}");
    let n = get(1, 100.0) as u64;
    for pair in args[2..].chunks(2) {
        let (w, fine): (usize, f32) = (pair[0].parse().unwrap(), pair[1].parse().unwrap());
        let t = Instant::now();
        let lens: Vec<usize> = (0..n).into_par_iter().map_init(|| beam::Beam::new(w, fine), |b, s| {
            b.search(&values, Acrobot::<Reference>::new(s).state()).unwrap().len()
        }).collect();
        let mean = lens.iter().sum::<usize>() as f64 / n as f64 - 1.0;
        println!("w {w} fine {fine}: return -{mean:.3} max {} min {} {:?}", lens.iter().max().unwrap(), lens.iter().min().unwrap(), t.elapsed());
    }
}
