//! A batch of any length, block size and settings is bit-identical to single acrobots.

#![no_main]

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, SimdLevel, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{ParamsRange, ResetBounds};
use acrobot::{Acrobot, Error, Fast, Params, Portable, ResetOptions, State, Step};
use acrobot_fuzz::{assert_settled, number, params, params_range, state};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut u = Unstructured::new(bytes);
    let _ = match u.int_in_range(0..=3) {
        Ok(0) => sequence::<Fast, 1>(&mut u),
        Ok(1) => sequence::<Fast, 3>(&mut u),
        Ok(2) => sequence::<Portable, 4>(&mut u),
        _ => sequence::<Fast, 16>(&mut u),
    };
});

type Many<A, const N: usize> = Batch<A, (Vec<Block<A, N>>, Vec<Pcg64>, Vec<LaneParams<A, N>>), N>;

/// A single acrobot that follows the rules of a batch.
struct Alone<A: Arithmetic> {
    acrobot: Acrobot<A>,
    elapsed: u32,
    reset_pending: bool,
}

/// What a step returns for one acrobot. The last is the final observation of an episode that the step reset.
type Returned = ([f32; 6], f32, bool, bool, Option<[f32; 6]>);

impl<A: Arithmetic> Alone<A> {
    /// Ends a pending reset, except in mode `NextStep`.
    fn settle(&mut self, settings: &Settings<A>) {
        match settings.autoreset {
            Autoreset::SameStep if self.reset_pending => {
                self.reset(settings, ResetOptions::default());
            }
            Autoreset::Disabled => self.reset_pending = false,
            _ => {}
        }
    }

    /// The seed is the acrobot's own.
    fn reset(&mut self, settings: &Settings<A>, ResetOptions { seed, bounds }: ResetOptions) {
        if let Some(seed) = seed {
            *self.acrobot.rng_mut() = seed.into();
        }
        if let Some(range) = &settings.range {
            let params = range.draw(self.acrobot.rng_mut());
            assert!(self.acrobot.set_params(params).is_ok());
        }
        let bounds = bounds.unwrap_or(settings.bounds);
        self.acrobot.reset_with(bounds.into());
        self.begin();
    }

    fn begin(&mut self) {
        (self.elapsed, self.reset_pending) = (0, false);
    }

    fn step(
        &mut self,
        settings: &Settings<A>,
        step: impl FnOnce(&mut Acrobot<A>) -> std::result::Result<Step, Error>,
    ) -> std::result::Result<Returned, Error> {
        if self.reset_pending && settings.autoreset == Autoreset::NextStep {
            // A reset ignores the action and draws no noise.
            self.reset(settings, ResetOptions::default());
            let first = self.acrobot.observation().to_array();
            return Ok((first, 0.0, false, false, None));
        }
        let step = step(&mut self.acrobot)?;
        self.elapsed = self.elapsed.saturating_add(1);
        let truncated = self.elapsed >= settings.limit.get();
        self.reset_pending = step.terminated || truncated;
        let last = step.observation.to_array();
        let resets = self.reset_pending && settings.autoreset == Autoreset::SameStep;
        self.settle(settings);
        Ok((
            self.acrobot.observation().to_array(),
            step.reward,
            step.terminated,
            truncated,
            resets.then_some(last),
        ))
    }

    fn member(&self) -> Member<A> {
        Member {
            params: *self.acrobot.params(),
            state: self.acrobot.state(),
            elapsed: self.elapsed,
            reset_pending: self.reset_pending,
            rng: self.acrobot.rng().clone(),
        }
    }
}

const MODES: [Autoreset; 3] = [
    Autoreset::NextStep,
    Autoreset::SameStep,
    Autoreset::Disabled,
];

struct Settings<A: Arithmetic> {
    autoreset: Autoreset,
    bounds: ResetBounds,
    limit: NonZeroU32,
    range: Option<ParamsRange<A::Scalar>>,
}

fn sequence<A: Arithmetic, const N: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let len: usize = u.int_in_range(1..=35)?;
    let seed = u.arbitrary::<u64>()?;
    let own_params = u.arbitrary()?;
    let blocks = len.div_ceil(N);
    let memory = (
        vec![Block::EMPTY; blocks],
        vec![Pcg64::UNSEEDED; len],
        vec![LaneParams::default(); if own_params { blocks } else { 0 }],
    );
    let batch = Many::<A, N>::new(seed, memory);
    let mut batch = batch.expect("it has a block for each N");
    let mut alone: Vec<_> = SeedSequence::new(seed)
        .spawn(len as u64)
        .map(|seed| Alone {
            acrobot: Acrobot::<A>::with_rng(seed.into()),
            elapsed: 0,
            reset_pending: false,
        })
        .collect();
    let mut settings = Settings {
        autoreset: *u.choose(&MODES)?,
        bounds: ResetBounds::DEFAULT,
        limit: u.arbitrary()?,
        range: None,
    };
    batch.set_autoreset(settings.autoreset);
    batch.set_limit(settings.limit);
    let levels = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];
    batch.set_simd_level(*u.choose(&levels)?);
    while !u.is_empty() {
        // 239 to 244 choose rare calls. The last digit of any other byte chooses the call.
        let call: u8 = u.arbitrary()?;
        let is_rare = (239..=244).contains(&call);
        match if is_rare { call } else { call % 10 } {
            241 => {
                let index = u.int_in_range(0..=len + N)?;
                let state: State<A::Scalar> = state(u)?.cast();
                let set = batch.set_state(index, state);
                assert_eq!(set.is_ok(), state.validate().is_ok() && index < len);
                if let Some(alone) = alone.get_mut(index).filter(|_| set.is_ok()) {
                    assert!(alone.acrobot.set_state(state).is_ok());
                }
            }
            242 => {
                let Ok(bounds) = ResetBounds::new(number(u, -0.1)?, number(u, 0.1)?) else {
                    continue;
                };
                let options = ResetOptions {
                    seed: u.arbitrary::<Option<u64>>()?.map(SeedSequence::new),
                    bounds: u.arbitrary::<bool>()?.then_some(bounds),
                };
                batch.reset_with(options.clone());
                reset(&mut alone, &settings, &options, |_| true);
            }
            243 => {
                let bits: u64 = u.arbitrary()?;
                let found = u.int_in_range(len - 1..=len + 1)?;
                let mask: Vec<bool> = (0..found).map(|i| bits >> i & 1 == 1).collect();
                let options = ResetOptions {
                    seed: u.arbitrary::<Option<u64>>()?.map(SeedSequence::new),
                    bounds: None,
                };
                let done = batch.reset_masked(&mask, options.clone());
                assert_eq!(done.is_ok(), found == len);
                reset(&mut alone, &settings, &options, |i| done.is_ok() && mask[i]);
            }
            240 => {
                let params: Params<A::Scalar> = params(u)?.cast();
                let index = u.int_in_range(0..=len + N)?;
                let set = batch.set_params_of(index, params);
                let valid = params.validate().is_ok() && index < len;
                assert_eq!(set.is_ok(), valid && own_params);
                if let Some(alone) = alone.get_mut(index).filter(|_| set.is_ok()) {
                    assert!(alone.acrobot.set_params(params).is_ok());
                }
            }
            239 => {
                let range = match u.arbitrary()? {
                    true => params_range(u)?.ok(),
                    false => None,
                };
                let set = batch.set_params_range(range);
                assert_eq!(set.is_ok(), own_params || range.is_none());
                if set.is_ok() {
                    settings.range = range;
                }
            }
            244 => {
                let mut torques = inputs(len, u, |u| {
                    Ok(A::Scalar::from_f64(u.arbitrary::<i8>()?.into()))
                })?;
                if let Some(torque) = torques.last_mut() {
                    *torque = A::Scalar::from_f64(number(u, 1.0)?);
                }
                let valid = torques.len() == len && torques.iter().all(|torque| torque.is_finite());
                step(
                    &mut batch,
                    &mut alone,
                    &settings,
                    valid,
                    |batch, buffers| batch.step(&torques, buffers),
                    |acrobot, index| acrobot.step_torque(torques[index]),
                );
            }
            0 => {
                let params: Params<A::Scalar> = params(u)?.cast();
                let set = batch.set_params(params);
                for alone in &mut alone {
                    assert_eq!(alone.acrobot.set_params(params).is_ok(), set.is_ok());
                }
            }
            1 => {
                if let Ok(bounds) = ResetBounds::new(number(u, -0.1)?, number(u, 0.1)?) {
                    settings.bounds = bounds;
                    batch.set_reset_bounds(bounds);
                }
            }
            2 => {
                batch.reset();
                reset(&mut alone, &settings, &ResetOptions::default(), |_| true);
            }
            3 => {
                let state: State<A::Scalar> = state(u)?.cast();
                let mut states = vec![state; u.int_in_range(len - 1..=len + 1)?];
                if let Some(last) = states.last_mut() {
                    *last = State::default();
                }
                let reset = batch.reset_to(&states);
                let valid = states.iter().all(|state| state.validate().is_ok());
                assert_eq!(reset.is_ok(), valid && states.len() == len);
                for (alone, state) in alone.iter_mut().zip(states).filter(|_| reset.is_ok()) {
                    assert!(alone.acrobot.set_state(state).is_ok());
                    alone.begin();
                }
            }
            4 => {
                let given = match u.arbitrary()? {
                    true => params(u)?.cast(),
                    false => *alone[0].acrobot.params(),
                };
                let member = Member {
                    params: given,
                    state: state(u)?.cast(),
                    elapsed: u.arbitrary()?,
                    reset_pending: u.arbitrary()?,
                    rng: Pcg64::new(u.arbitrary::<u64>()?),
                };
                let index = u.int_in_range(0..=len + N)?;
                let put = batch.set_member(index, member.clone());
                let valid = member.state.validate().is_ok() && given.validate().is_ok();
                let fits = own_params || given == *alone[0].acrobot.params();
                assert_eq!(put.is_ok(), valid && fits && index < len);
                if let Some(alone) = alone.get_mut(index).filter(|_| put.is_ok()) {
                    if own_params {
                        assert!(alone.acrobot.set_params(given).is_ok());
                    }
                    assert!(alone.acrobot.set_state(member.state).is_ok());
                    *alone.acrobot.rng_mut() = member.rng;
                    (alone.elapsed, alone.reset_pending) = (member.elapsed, member.reset_pending);
                    alone.settle(&settings);
                }
            }
            5 => {
                settings.autoreset = *u.choose(&MODES)?;
                settings.limit = u.arbitrary()?;
                batch.set_autoreset(settings.autoreset);
                batch.set_limit(settings.limit);
                alone.iter_mut().for_each(|alone| alone.settle(&settings));
            }
            _ => {
                // Sometimes an action is unknown, or the last one is missing.
                let last = *u.choose(&[0, 1, 2, 0, 1, 2, 0, 1, 2, 3, u8::MAX])?;
                let mut actions = inputs(len, u, |u| u.int_in_range(0..=2))?;
                if let Some(action) = actions.last_mut() {
                    *action = last;
                }
                let valid = actions.len() == len && actions.iter().all(|&action| action < 3);
                step(
                    &mut batch,
                    &mut alone,
                    &settings,
                    valid,
                    |batch, buffers| batch.step(&actions, buffers),
                    |acrobot, index| Ok(acrobot.step(actions[index].try_into()?)),
                );
            }
        }
        for (index, alone) in alone.iter().enumerate() {
            let state = batch.state(index).map(bits);
            assert_eq!(state, Some(bits(alone.acrobot.state())), "acrobot {index}");
            assert_eq!(batch.member(index), Some(alone.member()), "acrobot {index}");
        }
        assert_eq!((batch.member(len), batch.state(len)), (None, None));
    }
    Ok(())
}

/// Resets some acrobots. The seed is the batch's.
fn reset<A: Arithmetic>(
    alone: &mut [Alone<A>],
    settings: &Settings<A>,
    options: &ResetOptions,
    is_reset: impl Fn(usize) -> bool,
) {
    for (index, alone) in alone.iter_mut().enumerate().filter(|(i, _)| is_reset(*i)) {
        let seed = options.seed.as_ref().map(|seed| seed.child(index as u64));
        alone.reset(settings, ResetOptions { seed, ..*options });
    }
}

/// An input for each acrobot. Sometimes the last is missing.
fn inputs<'a, T>(
    len: usize,
    u: &mut Unstructured<'a>,
    mut input: impl FnMut(&mut Unstructured<'a>) -> Result<T>,
) -> Result<Vec<T>> {
    let found = len - usize::from(u.ratio(1, 16)?);
    (0..found).map(|_| input(u)).collect()
}

fn step<A: Arithmetic, const N: usize>(
    batch: &mut Many<A, N>,
    alone: &mut [Alone<A>],
    settings: &Settings<A>,
    valid: bool,
    step: impl FnOnce(&mut Many<A, N>, StepBuffers<'_>) -> std::result::Result<(), Error>,
    step_one: impl Fn(&mut Acrobot<A>, usize) -> std::result::Result<Step, Error>,
) {
    const UNTOUCHED: f32 = 9.0;
    let len = alone.len();
    let (mut rewards, mut terminated, mut truncated) =
        (vec![UNTOUCHED; len], vec![false; len], vec![false; len]);
    let (mut rows, mut finals) = (vec![[UNTOUCHED; 6]; len], vec![[UNTOUCHED; 6]; len]);
    let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
        .with_observations(&mut rows)
        .with_final_observations(&mut finals);
    let stepped = step(batch, buffers);
    assert_eq!(stepped.is_ok(), valid);
    if stepped.is_err() {
        assert!(
            rewards
                .into_iter()
                .chain(rows.concat())
                .all(|x| x == UNTOUCHED)
        );
        return;
    }
    for (index, alone) in alone.iter_mut().enumerate() {
        let returned = alone.step(settings, |acrobot| step_one(acrobot, index));
        let (row, reward, goal, last, final_row) = returned.expect("a valid input");
        let final_row = final_row.unwrap_or([UNTOUCHED; 6]);
        for (found, expected) in [(rows[index], row), (finals[index], final_row)] {
            let [found, expected] = [found, expected].map(|row| row.map(f32::to_bits));
            assert_eq!(found, expected, "acrobot {index}");
        }
        let returned = (rewards[index], terminated[index], truncated[index]);
        assert_eq!(returned, (reward, goal, last), "acrobot {index}");
        if alone.elapsed > 0 {
            assert_settled(alone.acrobot.state(), alone.acrobot.params());
        }
    }
}

/// The bits of a state, which distinguish 0 from −0.
fn bits<S: Real>(state: State<S>) -> [u64; 4] {
    <[S; 4]>::from(state).map(|x| x.to_f64().to_bits())
}
