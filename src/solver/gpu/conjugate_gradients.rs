use std::cell::RefCell;
use super::card::Card;
use super::frame::Four;
use crate::error::Result;
use crate::linalg::multilevel::Multilevel;
pub(super) struct ConjugateGradients { pub(super) right: wgpu::Buffer, pub(super) solution: wgpu::Buffer, pub(super) progress: wgpu::Buffer, n: usize, m: RefCell<Multilevel> }
impl ConjugateGradients {
    pub(super) fn new(card: &Card, mut m: Multilevel) -> Result<Self> {
        let n = m.parts().0.row_count();
        let b = (16 * n) as u64;
        Ok(Self { right: card.room("r", b)?, solution: card.room("s", b)?, progress: card.room("p", 32)?, n, m: RefCell::new(m) })
    }
    pub(super) fn submit(&self, card: &Card, _steps: u32) {
        let b: Vec<Vec<f32>> = card.read(&[(&self.right, 4 * self.n)]).unwrap();
        let mut m = self.m.borrow_mut();
        let n = self.n;
        let mut r: Vec<[f64; 4]> = b[0].chunks(4).map(|c| [c[0] as f64, c[1] as f64, c[2] as f64, 0.0]).collect();
        let mut x = vec![[0.0; 4]; n];
        let mut p = vec![[0.0; 4]; n];
        let mut q = vec![[0.0; 4]; n];
        let mut old = [0.0; 4];
        for it in 0..30 {
            m.parts().1.copy_from_slice(&r);
            m.run(false);
            let z: Vec<[f64; 4]> = m.parts().2.to_vec();
            let rz: [f64; 4] = std::array::from_fn(|l| (0..n).map(|i| r[i][l] * z[i][l]).sum());
            for i in 0..n { for l in 0..3 { let beta = if it == 0 || old[l] == 0.0 { 0.0 } else { rz[l] / old[l] }; p[i][l] = z[i][l] + beta * p[i][l]; } }
            m.parts().0.apply(0.0, -1.0, &[], &p, &mut q, false);
            for l in 0..3 {
                let pq: f64 = (0..n).map(|i| p[i][l] * q[i][l]).sum();
                let a = if pq > 0.0 { rz[l] / pq } else { 0.0 };
                for i in 0..n { x[i][l] += a * p[i][l]; r[i][l] -= a * q[i][l]; }
            }
            old = rz;
        }
        let x: Vec<Four> = x.iter().map(|x| x.map(|v| v as f32)).collect();
        card.write(&self.solution, &x);
    }
}
