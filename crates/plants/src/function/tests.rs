use super::{RobotFunction, Samples};
use crate::native::NativeRows;
use crate::shipped;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{self, Robot};
use std::ops::Range;

/// Samples one after the other.
struct Rows(Vec<Vec<f64>>);

impl Samples for Rows {
    fn entries(&self) -> usize {
        self.0[0].len()
    }

    fn samples(&self) -> usize {
        self.0.len()
    }

    fn rows<'a>(&'a self, samples: Range<usize>, room: &'a mut Vec<f64>) -> &'a [f64] {
        *room = self.0[samples].concat();
        room
    }
}

fn robot(name: &str) -> Robot {
    model::read(name, shipped::find(name).unwrap().text.as_bytes()).unwrap()
}

fn rows(samples: usize, entries: usize, seed: f64) -> Rows {
    let entry = |sample: usize, entry: usize| (seed + (sample * entries + entry) as f64).sin();
    Rows((0..samples).map(|sample| (0..entries).map(|k| entry(sample, k)).collect()).collect())
}

/// Every sample of a batch has the bits of a call, below and above the size that threads share.
#[test]
fn many_samples_have_the_bits_of_one() {
    let robot = robot("tulip");
    for name in [FunctionName::InverseDynamicsDerivatives, FunctionName::ContactPositions] {
        let [function, by_columns] =
            [(); 2].map(|()| RobotFunction::of(&robot, name).unwrap().remove(0));
        // what other processors do
        let batch = NativeRows::in_columns(&by_columns.routine, &[]);
        assert!(by_columns.batch.set(batch).is_ok());
        let all: usize = function.outputs().iter().map(|output| output.len()).sum();
        for samples in [1, 7, 600] {
            let given: Vec<Rows> =
                (0..function.arguments().len()).map(|k| rows(samples, 18, k as f64)).collect();
            let arguments: Vec<&dyn Samples> = given.iter().map(|one| one as _).collect();
            let mut found: Vec<Vec<f64>> =
                function.outputs().iter().map(|one| vec![0.0; samples * one.len()]).collect();
            let mut slices: Vec<&mut [f64]> = found.iter_mut().map(|one| &mut one[..]).collect();
            function.call_on_samples(&arguments, &mut slices).unwrap();
            let mut again = found.clone();
            again.iter_mut().for_each(|array| array.fill(f64::NAN));
            let mut slices: Vec<&mut [f64]> = again.iter_mut().map(|one| &mut one[..]).collect();
            by_columns.call_on_samples(&arguments, &mut slices).unwrap();
            assert!(found == again, "{name}, {samples} samples in columns");
            for sample in 0..samples {
                let one: Vec<&[f64]> = given.iter().map(|rows| &rows.0[sample][..]).collect();
                let mut expected = vec![0.0; all];
                function.call(&one, &mut expected).unwrap();
                let parts = found.iter().zip(function.outputs()).flat_map(|(array, shape)| {
                    array[sample * shape.len()..(sample + 1) * shape.len()].iter()
                });
                assert!(parts.eq(&expected), "{name}, sample {sample} of {samples}");
            }
        }
    }
}

#[test]
fn sizes_are_compared() {
    let function = RobotFunction::of(&robot("planar_2r"), FunctionName::MassMatrix).unwrap();
    let mut matrix = [0.0; 8];
    assert!(function[0].call_on_samples(&[&rows(2, 3, 0.0)], &mut [&mut matrix]).is_err());
    assert!(function[0].call_on_samples(&[&rows(3, 2, 0.0)], &mut [&mut matrix]).is_err());
    assert!(function[0].call_on_samples(&[], &mut [&mut matrix]).is_err());
    assert!(function[0].call_on_samples(&[&rows(2, 2, 0.0)], &mut [&mut matrix]).is_ok());
}

#[test]
fn functions_of_links_are_one_for_each() {
    let robot = robot("planar_3r");
    let functions = RobotFunction::of(&robot, FunctionName::LinkJacobian).unwrap();
    let links: Vec<_> = functions.iter().map(|one| one.link().unwrap().to_owned()).collect();
    let own: Vec<_> = robot.links.values().map(|link| link.name.clone()).collect();
    assert_eq!(links, own);
    // no contact points, no function of them
    assert!(RobotFunction::of(&robot, FunctionName::ContactPositions).unwrap().is_empty());
}
