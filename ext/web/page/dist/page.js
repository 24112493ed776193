var pm=Object.defineProperty;var Kh=i=>{throw TypeError(i)};var mm=(i,e,t)=>e in i?pm(i,e,{enumerable:!0,configurable:!0,writable:!0,value:t}):i[e]=t;var Zh=(i,e,t)=>mm(i,typeof e!="symbol"?e+"":e,t),il=(i,e,t)=>e.has(i)||Kh("Cannot "+t);var pt=(i,e,t)=>(il(i,e,"read from private field"),t?t.call(i):e.get(i)),er=(i,e,t)=>e.has(i)?Kh("Cannot add the same private member more than once"):e instanceof WeakSet?e.add(i):e.set(i,t),sl=(i,e,t,n)=>(il(i,e,"write to private field"),n?n.call(i,t):e.set(i,t),t),On=(i,e,t)=>(il(i,e,"access private method"),t);var rl=(i,e,t,n)=>({set _(s){sl(i,e,s,t)},get _(){return pt(i,e,n)}});const tn="u-",gm="uplot",_m=tn+"hz",vm=tn+"vt",xm=tn+"title",Sm=tn+"wrap",Mm=tn+"under",ym=tn+"over",Em=tn+"axis",Ds=tn+"off",bm=tn+"select",Tm=tn+"cursor-x",wm=tn+"cursor-y",Am=tn+"cursor-pt",Cm=tn+"legend",Rm=tn+"live",Pm=tn+"inline",Dm=tn+"series",Lm=tn+"marker",$h=tn+"label",Um=tn+"value",ro="width",oo="height",Zr="top",Jh="bottom",tr="left",ol="right",th="#000",Qh=th+"0",al="mousemove",eu="mousedown",ll="mouseup",tu="mouseenter",nu="mouseleave",iu="dblclick",Im="resize",Nm="scroll",su="change",va="dppxchange",nh="--",Or=typeof window<"u",jl=Or?document:null,Sr=Or?window:null,Fm=Or?navigator:null;let vt,No;function Kl(){let i=devicePixelRatio;vt!=i&&(vt=i,No&&$l(su,No,Kl),No=matchMedia(`(min-resolution: ${vt-.001}dppx) and (max-resolution: ${vt+.001}dppx)`),Fs(su,No,Kl),Sr.dispatchEvent(new CustomEvent(va)))}function zn(i,e){if(e!=null){let t=i.classList;!t.contains(e)&&t.add(e)}}function Zl(i,e){let t=i.classList;t.contains(e)&&t.remove(e)}function It(i,e,t){i.style[e]=t+"px"}function li(i,e,t,n){let s=jl.createElement(i);return e!=null&&zn(s,e),t?.insertBefore(s,n),s}function $n(i,e){return li("div",i,e)}const ru=new WeakMap;function bi(i,e,t,n,s){let r="translate("+e+"px,"+t+"px)",o=ru.get(i);r!=o&&(i.style.transform=r,ru.set(i,r),e<0||t<0||e>n||t>s?zn(i,Ds):Zl(i,Ds))}const ou=new WeakMap;function au(i,e,t){let n=e+t,s=ou.get(i);n!=s&&(ou.set(i,n),i.style.background=e,i.style.borderColor=t)}const lu=new WeakMap;function cu(i,e,t,n){let s=e+""+t,r=lu.get(i);s!=r&&(lu.set(i,s),i.style.height=t+"px",i.style.width=e+"px",i.style.marginLeft=n?-e/2+"px":0,i.style.marginTop=n?-t/2+"px":0)}const ih={passive:!0},Om={...ih,capture:!0};function Fs(i,e,t,n){e.addEventListener(i,t,n?Om:ih)}function $l(i,e,t,n){e.removeEventListener(i,t,ih)}Or&&Kl();function ci(i,e,t,n){let s;t=t||0,n=n||e.length-1;let r=n<=2147483647;for(;n-t>1;)s=r?t+n>>1:Wn((t+n)/2),e[s]<i?t=s:n=s;return i-e[t]<=e[n]-i?t:n}function md(i){return(t,n,s)=>{let r=-1,o=-1;for(let a=n;a<=s;a++)if(i(t[a])){r=a;break}for(let a=s;a>=n;a--)if(i(t[a])){o=a;break}return[r,o]}}const gd=i=>i!=null,_d=i=>i!=null&&i>0,Da=md(gd),Bm=md(_d);function km(i,e,t,n=0,s=!1){let r=s?Bm:Da,o=s?_d:gd;[e,t]=r(i,e,t);let a=i[e],l=i[e];if(e>-1)if(n==1)a=i[e],l=i[t];else if(n==-1)a=i[t],l=i[e];else for(let c=e;c<=t;c++){let u=i[c];o(u)&&(u<a?a=u:u>l&&(l=u))}return[a??Ct,l??-Ct]}function La(i,e,t,n){let s=fu(i),r=fu(e);i==e&&(s==-1?(i*=t,e/=t):(i/=t,e*=t));let o=t==10?Hi:vd,a=s==1?Wn:Qn,l=r==1?Qn:Wn,c=a(o(Jt(i))),u=l(o(Jt(e))),h=Tr(t,c),f=Tr(t,u);return t==10&&(c<0&&(h=Rt(h,-c)),u<0&&(f=Rt(f,-u))),n||t==2?(i=h*s,e=f*r):(i=yd(i,h),e=Ua(e,f)),[i,e]}function sh(i,e,t,n){let s=La(i,e,t,n);return i==0&&(s[0]=0),e==0&&(s[1]=0),s}const rh=.1,hu={mode:3,pad:rh},ho={pad:0,soft:null,mode:0},zm={min:ho,max:ho};function xa(i,e,t,n){return Ia(t)?uu(i,e,t):(ho.pad=t,ho.soft=n?0:null,ho.mode=n?3:0,uu(i,e,zm))}function mt(i,e){return i??e}function Vm(i,e,t){for(e=mt(e,0),t=mt(t,i.length-1);e<=t;){if(i[e]!=null)return!0;e++}return!1}function uu(i,e,t){let n=t.min,s=t.max,r=mt(n.pad,0),o=mt(s.pad,0),a=mt(n.hard,-Ct),l=mt(s.hard,Ct),c=mt(n.soft,Ct),u=mt(s.soft,-Ct),h=mt(n.mode,0),f=mt(s.mode,0),m=e-i,_=Hi(m),v=Tn(Jt(i),Jt(e)),p=Hi(v),d=Jt(p-_);(m<1e-24||d>10)&&(m=0,(i==0||e==0)&&(m=1e-24,h==2&&c!=Ct&&(r=0),f==2&&u!=-Ct&&(o=0)));let b=m||v||1e3,w=Hi(b),M=Tr(10,Wn(w)),B=b*(m==0?i==0?.1:1:r),D=Rt(yd(i-B,M/10),24),L=i>=c&&(h==1||h==3&&D<=c||h==2&&D>=c)?c:Ct,U=Tn(a,D<L&&i>=L?L:hi(L,D)),T=b*(m==0?e==0?.1:1:o),y=Rt(Ua(e+T,M/10),24),R=e<=u&&(f==1||f==3&&y>=u||f==2&&y<=u)?u:-Ct,K=hi(l,y>R&&e<=R?R:Tn(R,y));return U==K&&U==0&&(K=100),[U,K]}const Hm=new Intl.NumberFormat(Or?Fm.language:"en-US"),oh=i=>Hm.format(i),Yn=Math,ua=Yn.PI,Jt=Yn.abs,Wn=Yn.floor,$t=Yn.round,Qn=Yn.ceil,hi=Yn.min,Tn=Yn.max,Tr=Yn.pow,fu=Yn.sign,Hi=Yn.log10,vd=Yn.log2,Gm=(i,e=1)=>Yn.sinh(i)*e,cl=(i,e=1)=>Yn.asinh(i/e),Ct=1/0;function du(i){return(Hi((i^i>>31)-(i>>31))|0)+1}function Jl(i,e,t){return hi(Tn(i,e),t)}function xd(i){return typeof i=="function"}function rt(i){return xd(i)?i:()=>i}const Wm=()=>{},Sd=i=>i,Md=(i,e)=>e,Xm=i=>null,pu=i=>!0,mu=(i,e)=>i==e,Ym=/\.\d*?(?=9{6,}|0{6,})/gm,Os=i=>{if(bd(i)||ds.has(i))return i;const e=`${i}`,t=e.match(Ym);if(t==null)return i;let n=t[0].length-1;if(e.indexOf("e-")!=-1){let[s,r]=e.split("e");return+`${Os(s)}e${r}`}return Rt(i,n)};function Cs(i,e){return Os(Rt(Os(i/e))*e)}function Ua(i,e){return Os(Qn(Os(i/e))*e)}function yd(i,e){return Os(Wn(Os(i/e))*e)}function Rt(i,e=0){if(bd(i))return i;let t=10**e,n=i*t*(1+Number.EPSILON);return $t(n)/t}const ds=new Map;function Ed(i){return((""+i).split(".")[1]||"").length}function _o(i,e,t,n){let s=[],r=n.map(Ed);for(let o=e;o<t;o++){let a=Jt(o),l=Rt(Tr(i,o),a);for(let c=0;c<n.length;c++){let u=i==10?+`${n[c]}e${o}`:n[c]*l,h=(o>=0?0:a)+(o>=r[c]?0:r[c]),f=i==10?u:Rt(u,h);s.push(f),ds.set(f,h)}}return s}const uo={},ah=[],wr=[null,null],os=Array.isArray,bd=Number.isInteger,qm=i=>i===void 0;function gu(i){return typeof i=="string"}function Ia(i){let e=!1;if(i!=null){let t=i.constructor;e=t==null||t==Object}return e}function jm(i){return i!=null&&typeof i=="object"}const Km=Object.getPrototypeOf(Uint8Array),Td="__proto__";function Ar(i,e=Ia){let t;if(os(i)){let n=i.find(s=>s!=null);if(os(n)||e(n)){t=Array(i.length);for(let s=0;s<i.length;s++)t[s]=Ar(i[s],e)}else t=i.slice()}else if(i instanceof Km)t=i.slice();else if(e(i)){t={};for(let n in i)n!=Td&&(t[n]=Ar(i[n],e))}else t=i;return t}function qt(i){let e=arguments;for(let t=1;t<e.length;t++){let n=e[t];for(let s in n)s!=Td&&(Ia(i[s])?qt(i[s],Ar(n[s])):i[s]=Ar(n[s]))}return i}const Zm=0,$m=1,Jm=2;function Qm(i,e,t){for(let n=0,s,r=-1;n<e.length;n++){let o=e[n];if(o>r){for(s=o-1;s>=0&&i[s]==null;)i[s--]=null;for(s=o+1;s<t&&i[s]==null;)i[r=s++]=null}}}function eg(i,e){if(ig(i)){let o=i[0].slice();for(let a=1;a<i.length;a++)o.push(...i[a].slice(1));return sg(o[0])||(o=ng(o)),o}let t=new Set;for(let o=0;o<i.length;o++){let l=i[o][0],c=l.length;for(let u=0;u<c;u++)t.add(l[u])}let n=[Array.from(t).sort((o,a)=>o-a)],s=n[0].length,r=new Map;for(let o=0;o<s;o++)r.set(n[0][o],o);for(let o=0;o<i.length;o++){let a=i[o],l=a[0];for(let c=1;c<a.length;c++){let u=a[c],h=Array(s).fill(void 0),f=e?e[o][c]:$m,m=[];for(let _=0;_<u.length;_++){let v=u[_],p=r.get(l[_]);v===null?f!=Zm&&(h[p]=v,f==Jm&&m.push(p)):h[p]=v}Qm(h,m,s),n.push(h)}}return n}const tg=typeof queueMicrotask>"u"?i=>Promise.resolve().then(i):queueMicrotask;function ng(i){let e=i[0],t=e.length,n=Array(t);for(let r=0;r<n.length;r++)n[r]=r;n.sort((r,o)=>e[r]-e[o]);let s=[];for(let r=0;r<i.length;r++){let o=i[r],a=Array(t);for(let l=0;l<t;l++)a[l]=o[n[l]];s.push(a)}return s}function ig(i){let e=i[0][0],t=e.length;for(let n=1;n<i.length;n++){let s=i[n][0];if(s.length!=t)return!1;if(s!=e){for(let r=0;r<t;r++)if(s[r]!=e[r])return!1}}return!0}function sg(i,e=100){const t=i.length;if(t<=1)return!0;let n=0,s=t-1;for(;n<=s&&i[n]==null;)n++;for(;s>=n&&i[s]==null;)s--;if(s<=n)return!0;const r=Tn(1,Wn((s-n+1)/e));for(let o=i[n],a=n+r;a<=s;a+=r){const l=i[a];if(l!=null){if(l<=o)return!1;o=l}}return!0}const wd=["January","February","March","April","May","June","July","August","September","October","November","December"],Ad=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function Cd(i){return i.slice(0,3)}const rg=Ad.map(Cd),og=wd.map(Cd),ag={MMMM:wd,MMM:og,WWWW:Ad,WWW:rg};function $r(i){return(i<10?"0":"")+i}function lg(i){return(i<10?"00":i<100?"0":"")+i}const cg={YYYY:i=>i.getFullYear(),YY:i=>(i.getFullYear()+"").slice(2),MMMM:(i,e)=>e.MMMM[i.getMonth()],MMM:(i,e)=>e.MMM[i.getMonth()],MM:i=>$r(i.getMonth()+1),M:i=>i.getMonth()+1,DD:i=>$r(i.getDate()),D:i=>i.getDate(),WWWW:(i,e)=>e.WWWW[i.getDay()],WWW:(i,e)=>e.WWW[i.getDay()],HH:i=>$r(i.getHours()),H:i=>i.getHours(),h:i=>{let e=i.getHours();return e==0?12:e>12?e-12:e},AA:i=>i.getHours()>=12?"PM":"AM",aa:i=>i.getHours()>=12?"pm":"am",a:i=>i.getHours()>=12?"p":"a",mm:i=>$r(i.getMinutes()),m:i=>i.getMinutes(),ss:i=>$r(i.getSeconds()),s:i=>i.getSeconds(),fff:i=>lg(i.getMilliseconds())};function lh(i,e){e=e||ag;let t=[],n=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=n.exec(i);)t.push(s[0][0]=="{"?cg[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<t.length;a++)o+=typeof t[a]=="string"?t[a]:t[a](r,e);return o}}const hg=new Intl.DateTimeFormat().resolvedOptions().timeZone;function ug(i,e){let t;return e=="UTC"||e=="Etc/UTC"?t=new Date(+i+i.getTimezoneOffset()*6e4):e==hg?t=i:(t=new Date(i.toLocaleString("en-US",{timeZone:e})),t.setMilliseconds(i.getMilliseconds())),t}const Rd=i=>i%1==0,Sa=[1,2,2.5,5],fg=_o(10,-32,0,Sa),Pd=_o(10,0,32,Sa),dg=Pd.filter(Rd),Rs=fg.concat(Pd),ch=`
`,Dd="{YYYY}",_u=ch+Dd,Ld="{M}/{D}",ao=ch+Ld,Fo=ao+"/{YY}",Ud="{aa}",pg="{h}:{mm}",_r=pg+Ud,vu=ch+_r,xu=":{ss}",Mt=null;function Id(i){let e=i*1e3,t=e*60,n=t*60,s=n*24,r=s*30,o=s*365,l=(i==1?_o(10,0,3,Sa).filter(Rd):_o(10,-3,0,Sa)).concat([e,e*5,e*10,e*15,e*30,t,t*5,t*10,t*15,t*30,n,n*2,n*3,n*4,n*6,n*8,n*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]);const c=[[o,Dd,Mt,Mt,Mt,Mt,Mt,Mt,1],[s*28,"{MMM}",_u,Mt,Mt,Mt,Mt,Mt,1],[s,Ld,_u,Mt,Mt,Mt,Mt,Mt,1],[n,"{h}"+Ud,Fo,Mt,ao,Mt,Mt,Mt,1],[t,_r,Fo,Mt,ao,Mt,Mt,Mt,1],[e,xu,Fo+" "+_r,Mt,ao+" "+_r,Mt,vu,Mt,1],[i,xu+".{fff}",Fo+" "+_r,Mt,ao+" "+_r,Mt,vu,Mt,1]];function u(h){return(f,m,_,v,p,d)=>{let b=[],w=p>=o,M=p>=r&&p<o,B=h(_),D=Rt(B*i,3),L=hl(B.getFullYear(),w?0:B.getMonth(),M||w?1:B.getDate()),U=Rt(L*i,3);if(M||w){let T=M?p/r:0,y=w?p/o:0,R=D==U?D:Rt(hl(L.getFullYear()+y,L.getMonth()+T,1)*i,3),K=new Date($t(R/i)),F=K.getFullYear(),G=K.getMonth();for(let Z=0;R<=v;Z++){let j=hl(F+y*Z,G+T*Z,1),ee=j-h(Rt(j*i,3));R=Rt((+j+ee)*i,3),R<=v&&b.push(R)}}else{let T=p>=s?s:p,y=Wn(_)-Wn(D),R=U+y+Ua(D-U,T);b.push(R);let K=h(R),F=K.getHours()+K.getMinutes()/t+K.getSeconds()/n,G=p/n,Z=f.axes[m]._space,j=d/Z;for(;R=Rt(R+p,i==1?0:3),!(R>v);)if(G>1){let ee=Wn(Rt(F+G,6))%24,ce=h(R).getHours()-ee;ce>1&&(ce=-1),R-=ce*n,F=(F+G)%24;let me=b[b.length-1];Rt((R-me)/p,3)*j>=.7&&b.push(R)}else b.push(R)}return b}}return[l,c,u]}const[mg,gg,_g]=Id(1),[vg,xg,Sg]=Id(.001);_o(2,-53,53,[1]);function Su(i,e){return i.map(t=>t.map((n,s)=>s==0||s==8||n==null?n:e(s==1||t[8]==0?n:t[1]+n)))}function Mu(i,e){return(t,n,s,r,o)=>{let a=e.find(_=>o>=_[0])||e[e.length-1],l,c,u,h,f,m;return n.map(_=>{let v=i(_),p=v.getFullYear(),d=v.getMonth(),b=v.getDate(),w=v.getHours(),M=v.getMinutes(),B=v.getSeconds(),D=p!=l&&a[2]||d!=c&&a[3]||b!=u&&a[4]||w!=h&&a[5]||M!=f&&a[6]||B!=m&&a[7]||a[1];return l=p,c=d,u=b,h=w,f=M,m=B,D(v)})}}function Mg(i,e){let t=lh(e);return(n,s,r,o,a)=>s.map(l=>t(i(l)))}function hl(i,e,t){return new Date(i,e,t)}function yu(i,e){return e(i)}const yg="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Eu(i,e){return(t,n,s,r)=>r==null?nh:e(i(n))}function Eg(i,e){let t=i.series[e];return t.width?t.stroke(i,e):t.points.width?t.points.stroke(i,e):null}function bg(i,e){return i.series[e].fill(i,e)}const Tg={show:!0,live:!0,isolate:!1,mount:Wm,markers:{show:!0,width:2,stroke:Eg,fill:bg,dash:"solid"},idx:null,idxs:null,values:[]};function wg(i,e){let t=i.cursor.points,n=$n(),s=t.size(i,e);It(n,ro,s),It(n,oo,s);let r=s/-2;It(n,"marginLeft",r),It(n,"marginTop",r);let o=t.width(i,e,s);return o&&It(n,"borderWidth",o),n}function Ag(i,e){let t=i.series[e].points;return t._fill||t._stroke}function Cg(i,e){let t=i.series[e].points;return t._stroke||t._fill}function Rg(i,e){return i.series[e].points.size}const ul=[0,0];function Pg(i,e,t){return ul[0]=e,ul[1]=t,ul}function Oo(i,e,t,n=!0){return s=>{s.button==0&&(!n||s.target==e)&&t(s)}}function fl(i,e,t,n=!0){return s=>{(!n||s.target==e)&&t(s)}}const Dg={show:!0,x:!0,y:!0,lock:!1,move:Pg,points:{one:!1,show:wg,size:Rg,width:0,stroke:Cg,fill:Ag},bind:{mousedown:Oo,mouseup:Oo,click:Oo,dblclick:Oo,mousemove:fl,mouseleave:fl,mouseenter:fl},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(i,e)=>{e.stopPropagation(),e.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(i,e,t,n,s)=>n-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Nd={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},hh=qt({},Nd,{filter:Md}),Fd=qt({},hh,{size:10}),Od=qt({},Nd,{show:!1}),uh='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Bd="bold "+uh,kd=1.5,bu={show:!0,scale:"x",stroke:th,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Bd,side:2,grid:hh,ticks:Fd,border:Od,font:uh,lineGap:kd,rotate:0},Lg="Value",Ug="Time",Tu={show:!0,scale:"x",auto:!1,sorted:1,min:Ct,max:-Ct,idxs:[]};function Ig(i,e,t,n,s){return e.map(r=>r==null?"":oh(r))}function Ng(i,e,t,n,s,r,o){let a=[],l=ds.get(s)||0;t=o?t:Rt(Ua(t,s),l);for(let c=t;c<=n;c=Rt(c+s,l))a.push(Object.is(c,-0)?0:c);return a}function Ql(i,e,t,n,s,r,o){const a=[],l=i.scales[i.axes[e].scale].log,c=l==10?Hi:vd,u=Wn(c(t));s=Tr(l,u),l==10&&(s=Rs[ci(s,Rs)]);let h=t,f=s*l;l==10&&(f=Rs[ci(f,Rs)]);do a.push(h),h=h+s,l==10&&!ds.has(h)&&(h=Rt(h,ds.get(s))),h>=f&&(s=h,f=s*l,l==10&&(f=Rs[ci(f,Rs)]));while(h<=n);return a}function Fg(i,e,t,n,s,r,o){let l=i.scales[i.axes[e].scale].asinh,c=n>l?Ql(i,e,Tn(l,t),n,s):[l],u=n>=0&&t<=0?[0]:[];return(t<-l?Ql(i,e,Tn(l,-n),-t,s):[l]).reverse().map(f=>-f).concat(u,c)}const zd=/./,Og=/[12357]/,Bg=/[125]/,wu=/1/,ec=(i,e,t,n)=>i.map((s,r)=>e==4&&s==0||r%n==0&&t.test(s.toExponential()[s<0?1:0])?s:null);function kg(i,e,t,n,s){let r=i.axes[t],o=r.scale,a=i.scales[o],l=i.valToPos,c=r._space,u=l(10,o),h=l(9,o)-u>=c?zd:l(7,o)-u>=c?Og:l(5,o)-u>=c?Bg:wu;if(h==wu){let f=Jt(l(1,o)-u);if(f<c)return ec(e.slice().reverse(),a.distr,h,Qn(c/f)).reverse()}return ec(e,a.distr,h,1)}function zg(i,e,t,n,s){let r=i.axes[t],o=r.scale,a=r._space,l=i.valToPos,c=Jt(l(1,o)-l(2,o));return c<a?ec(e.slice().reverse(),3,zd,Qn(a/c)).reverse():e}function Vg(i,e,t,n){return n==null?nh:e==null?"":oh(e)}const Au={show:!0,scale:"y",stroke:th,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:Bd,side:3,grid:hh,ticks:Fd,border:Od,font:uh,lineGap:kd,rotate:0};function Hg(i,e){let t=3+(i||1)*2;return Rt(t*e,3)}function Gg(i,e){let{scale:t,idxs:n}=i.series[0],s=i._data[0],r=i.valToPos(s[n[0]],t,!0),o=i.valToPos(s[n[1]],t,!0),a=Jt(o-r),l=i.series[e],c=a/(l.points.space*vt);return n[1]-n[0]<=c}const Cu={scale:null,auto:!0,sorted:0,min:Ct,max:-Ct},Vd=(i,e,t,n,s)=>s,Ru={show:!0,auto:!0,sorted:0,gaps:Vd,alpha:1,facets:[qt({},Cu,{scale:"x"}),qt({},Cu,{scale:"y"})]},Pu={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Vd,alpha:1,points:{show:Gg,filter:null},values:null,min:Ct,max:-Ct,idxs:[],path:null,clip:null};function Wg(i,e,t,n,s){return t/10}const Hd={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},Xg=qt({},Hd,{time:!1,ori:1}),Du={};function Gd(i,e){let t=Du[i];return t||(t={key:i,plots:[],sub(n){t.plots.push(n)},unsub(n){t.plots=t.plots.filter(s=>s!=n)},pub(n,s,r,o,a,l,c){for(let u=0;u<t.plots.length;u++)t.plots[u]!=s&&t.plots[u].pub(n,s,r,o,a,l,c)}},i!=null&&(Du[i]=t)),t}const Cr=1,tc=2;function Vs(i,e,t){const n=i.mode,s=i.series[e],r=n==2?i._data[e]:i._data,o=i.scales,a=i.bbox;let l=r[0],c=n==2?r[1]:r[e],u=n==2?o[s.facets[0].scale]:o[i.series[0].scale],h=n==2?o[s.facets[1].scale]:o[s.scale],f=a.left,m=a.top,_=a.width,v=a.height,p=i.valToPosH,d=i.valToPosV;return u.ori==0?t(s,l,c,u,h,p,d,f,m,_,v,Fa,Br,Ba,Xd,qd):t(s,l,c,u,h,d,p,m,f,v,_,Oa,kr,ph,Yd,jd)}function fh(i,e){let t=0,n=0,s=mt(i.bands,ah);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==e?t=o.dir:o.series[1]==e&&(o.dir==1?n|=1:n|=2)}return[t,n==1?-1:n==2?1:n==3?2:0]}function Yg(i,e,t,n,s){let r=i.mode,o=i.series[e],a=r==2?o.facets[1].scale:o.scale,l=i.scales[a];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function Gi(i,e,t,n,s,r){return Vs(i,e,(o,a,l,c,u,h,f,m,_,v,p)=>{let d=o.pxRound;const b=c.dir*(c.ori==0?1:-1),w=c.ori==0?Br:kr;let M,B;b==1?(M=t,B=n):(M=n,B=t);let D=d(h(a[M],c,v,m)),L=d(f(l[M],u,p,_)),U=d(h(a[B],c,v,m)),T=d(f(r==1?u.max:u.min,u,p,_)),y=new Path2D(s);return w(y,U,T),w(y,D,T),w(y,D,L),y})}function Na(i,e,t,n,s,r){let o=null;if(i.length>0){o=new Path2D;const a=e==0?Ba:ph;let l=t;for(let h=0;h<i.length;h++){let f=i[h];if(f[1]>f[0]){let m=f[0]-l;m>0&&a(o,l,n,m,n+r),l=f[1]}}let c=t+s-l,u=10;c>0&&a(o,l,n-u/2,c,n+r+u)}return o}function qg(i,e,t){let n=i[i.length-1];n&&n[0]==e?n[1]=t:i.push([e,t])}function dh(i,e,t,n,s,r,o){let a=[],l=i.length;for(let c=s==1?t:n;c>=t&&c<=n;c+=s)if(e[c]===null){let h=c,f=c;if(s==1)for(;++c<=n&&e[c]===null;)f=c;else for(;--c>=t&&e[c]===null;)f=c;let m=r(i[h]),_=f==h?m:r(i[f]),v=h-s;m=o<=0&&v>=0&&v<l?r(i[v]):m;let d=f+s;_=o>=0&&d>=0&&d<l?r(i[d]):_,_>=m&&a.push([m,_])}return a}function Lu(i){return i==0?Sd:i==1?$t:e=>Cs(e,i)}function Wd(i){let e=i==0?Fa:Oa,t=i==0?(s,r,o,a,l,c)=>{s.arcTo(r,o,a,l,c)}:(s,r,o,a,l,c)=>{s.arcTo(o,r,l,a,c)},n=i==0?(s,r,o,a,l)=>{s.rect(r,o,a,l)}:(s,r,o,a,l)=>{s.rect(o,r,l,a)};return(s,r,o,a,l,c=0,u=0)=>{c==0&&u==0?n(s,r,o,a,l):(c=hi(c,a/2,l/2),u=hi(u,a/2,l/2),e(s,r+c,o),t(s,r+a,o,r+a,o+l,c),t(s,r+a,o+l,r,o+l,u),t(s,r,o+l,r,o,u),t(s,r,o,r+a,o,c),s.closePath())}}const Fa=(i,e,t)=>{i.moveTo(e,t)},Oa=(i,e,t)=>{i.moveTo(t,e)},Br=(i,e,t)=>{i.lineTo(e,t)},kr=(i,e,t)=>{i.lineTo(t,e)},Ba=Wd(0),ph=Wd(1),Xd=(i,e,t,n,s,r)=>{i.arc(e,t,n,s,r)},Yd=(i,e,t,n,s,r)=>{i.arc(t,e,n,s,r)},qd=(i,e,t,n,s,r,o)=>{i.bezierCurveTo(e,t,n,s,r,o)},jd=(i,e,t,n,s,r,o)=>{i.bezierCurveTo(t,e,s,n,o,r)};function Kd(i){return(e,t,n,s,r)=>Vs(e,t,(o,a,l,c,u,h,f,m,_,v,p)=>{let{pxRound:d,points:b}=o,w,M;c.ori==0?(w=Fa,M=Xd):(w=Oa,M=Yd);const B=Rt(b.width*vt,3);let D=(b.size-b.width)/2*vt,L=Rt(D*2,3),U=new Path2D,T=new Path2D,{left:y,top:R,width:K,height:F}=e.bbox;Ba(T,y-L,R-L,K+L*2,F+L*2);const G=Z=>{if(l[Z]!=null){let j=d(h(a[Z],c,v,m)),ee=d(f(l[Z],u,p,_));w(U,j+D,ee),M(U,j,ee,D,0,ua*2)}};if(r)r.forEach(G);else for(let Z=n;Z<=s;Z++)G(Z);return{stroke:B>0?U:null,fill:U,clip:T,flags:Cr|tc}})}function Zd(i){return(e,t,n,s,r,o)=>{n!=s&&(r!=n&&o!=n&&i(e,t,n),r!=s&&o!=s&&i(e,t,s),i(e,t,o))}}const jg=Zd(Br),Kg=Zd(kr);function $d(i){const e=mt(i?.alignGaps,0);return(t,n,s,r)=>Vs(t,n,(o,a,l,c,u,h,f,m,_,v,p)=>{[s,r]=Da(l,s,r);let d=o.pxRound,b=F=>d(h(F,c,v,m)),w=F=>d(f(F,u,p,_)),M,B;c.ori==0?(M=Br,B=jg):(M=kr,B=Kg);const D=c.dir*(c.ori==0?1:-1),L={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Cr},U=L.stroke;let T=!1;if(r-s>=v*4){let F=pe=>t.posToVal(pe,c.key,!0),G=null,Z=null,j,ee,Q,ue=b(a[D==1?s:r]),ce=b(a[s]),me=b(a[r]),Se=F(D==1?ce+1:me-1);for(let pe=D==1?s:r;pe>=s&&pe<=r;pe+=D){let ie=a[pe],ge=(D==1?ie<Se:ie>Se)?ue:b(ie),oe=l[pe];ge==ue?oe!=null?(ee=oe,G==null?(M(U,ge,w(ee)),j=G=Z=ee):ee<G?G=ee:ee>Z&&(Z=ee)):oe===null&&(T=!0):(G!=null&&B(U,ue,w(G),w(Z),w(j),w(ee)),oe!=null?(ee=oe,M(U,ge,w(ee)),G=Z=j=ee):(G=Z=null,oe===null&&(T=!0)),ue=ge,Se=F(ue+D))}G!=null&&G!=Z&&Q!=ue&&B(U,ue,w(G),w(Z),w(j),w(ee))}else for(let F=D==1?s:r;F>=s&&F<=r;F+=D){let G=l[F];G===null?T=!0:G!=null&&M(U,b(a[F]),w(G))}let[R,K]=fh(t,n);if(o.fill!=null||R!=0){let F=L.fill=new Path2D(U),G=o.fillTo(t,n,o.min,o.max,R),Z=w(G),j=b(a[s]),ee=b(a[r]);D==-1&&([ee,j]=[j,ee]),M(F,ee,Z),M(F,j,Z)}if(!o.spanGaps){let F=[];T&&F.push(...dh(a,l,s,r,D,b,e)),L.gaps=F=o.gaps(t,n,s,r,F),L.clip=Na(F,c.ori,m,_,v,p)}return K!=0&&(L.band=K==2?[Gi(t,n,s,r,U,-1),Gi(t,n,s,r,U,1)]:Gi(t,n,s,r,U,K)),L})}function Zg(i){const e=mt(i.align,1),t=mt(i.ascDesc,!1),n=mt(i.alignGaps,0),s=mt(i.extend,!1);return(r,o,a,l)=>Vs(r,o,(c,u,h,f,m,_,v,p,d,b,w)=>{[a,l]=Da(h,a,l);let M=c.pxRound,{left:B,width:D}=r.bbox,L=ce=>M(_(ce,f,b,p)),U=ce=>M(v(ce,m,w,d)),T=f.ori==0?Br:kr;const y={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Cr},R=y.stroke,K=f.dir*(f.ori==0?1:-1);let F=U(h[K==1?a:l]),G=L(u[K==1?a:l]),Z=G,j=G;s&&e==-1&&(j=B,T(R,j,F)),T(R,G,F);for(let ce=K==1?a:l;ce>=a&&ce<=l;ce+=K){let me=h[ce];if(me==null)continue;let Se=L(u[ce]),pe=U(me);e==1?T(R,Se,F):T(R,Z,pe),T(R,Se,pe),F=pe,Z=Se}let ee=Z;s&&e==1&&(ee=B+D,T(R,ee,F));let[Q,ue]=fh(r,o);if(c.fill!=null||Q!=0){let ce=y.fill=new Path2D(R),me=c.fillTo(r,o,c.min,c.max,Q),Se=U(me);T(ce,ee,Se),T(ce,j,Se)}if(!c.spanGaps){let ce=[];ce.push(...dh(u,h,a,l,K,L,n));let me=c.width*vt/2,Se=t||e==1?me:-me,pe=t||e==-1?-me:me;ce.forEach(ie=>{ie[0]+=Se,ie[1]+=pe}),y.gaps=ce=c.gaps(r,o,a,l,ce),y.clip=Na(ce,f.ori,p,d,b,w)}return ue!=0&&(y.band=ue==2?[Gi(r,o,a,l,R,-1),Gi(r,o,a,l,R,1)]:Gi(r,o,a,l,R,ue)),y})}function Uu(i,e,t,n,s,r,o=Ct){if(i.length>1){let a=null;for(let l=0,c=1/0;l<i.length;l++)if(e[l]!==void 0){if(a!=null){let u=Jt(i[l]-i[a]);u<c&&(c=u,o=Jt(t(i[l],n,s,r)-t(i[a],n,s,r)))}a=l}}return o}function $g(i){i=i||uo;const e=mt(i.size,[.6,Ct,1]),t=i.align||0,n=i.gap||0;let s=i.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;const r=rt(s),o=1-e[0],a=mt(e[1],Ct),l=mt(e[2],1),c=mt(i.disp,uo),u=mt(i.each,m=>{}),{fill:h,stroke:f}=c;return(m,_,v,p)=>Vs(m,_,(d,b,w,M,B,D,L,U,T,y,R)=>{let K=d.pxRound,F=t,G=n*vt,Z=a*vt,j=l*vt,ee,Q;M.ori==0?[ee,Q]=r(m,_):[Q,ee]=r(m,_);const ue=M.dir*(M.ori==0?1:-1);let ce=M.ori==0?Ba:ph,me=M.ori==0?u:(V,te,Me,_e,Te,je,fe)=>{u(V,te,Me,Te,_e,fe,je)},Se=mt(m.bands,ah).find(V=>V.series[0]==_),pe=Se!=null?Se.dir:0,ie=d.fillTo(m,_,d.min,d.max,pe),ae=K(L(ie,B,R,T)),ge,oe,ke,Ve=y,Ie=K(d.width*vt),ot=!1,Ke=null,at=null,k=null,jt=null;h!=null&&(Ie==0||f!=null)&&(ot=!0,Ke=h.values(m,_,v,p),at=new Map,new Set(Ke).forEach(V=>{V!=null&&at.set(V,new Path2D)}),Ie>0&&(k=f.values(m,_,v,p),jt=new Map,new Set(k).forEach(V=>{V!=null&&jt.set(V,new Path2D)})));let{x0:$e,size:Qe}=c;if($e!=null&&Qe!=null){F=1,b=$e.values(m,_,v,p),$e.unit==2&&(b=b.map(Me=>m.posToVal(U+Me*y,M.key,!0)));let V=Qe.values(m,_,v,p);Qe.unit==2?oe=V[0]*y:oe=D(V[0],M,y,U)-D(0,M,y,U),Ve=Uu(b,w,D,M,y,U,Ve),ke=Ve-oe+G}else Ve=Uu(b,w,D,M,y,U,Ve),ke=Ve*o+G,oe=Ve-ke;ke<1&&(ke=0),Ie>=oe/2&&(Ie=0),ke<5&&(K=Sd);let He=ke>0,ct=Ve-ke-(He?Ie:0);oe=K(Jl(ct,j,Z)),ge=(F==0?oe/2:F==ue?0:oe)-F*ue*((F==0?G/2:0)+(He?Ie/2:0));const Pe={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},C=ot?null:new Path2D;let S=null;if(Se!=null)S=m.data[Se.series[1]];else{let{y0:V,y1:te}=c;V!=null&&te!=null&&(w=te.values(m,_,v,p),S=V.values(m,_,v,p))}let q=ee*oe,J=Q*oe;for(let V=ue==1?v:p;V>=v&&V<=p;V+=ue){let te=w[V];if(te==null)continue;if(S!=null){let Oe=S[V]??0;if(te-Oe==0)continue;ae=L(Oe,B,R,T)}let Me=M.distr!=2||c!=null?b[V]:V,_e=D(Me,M,y,U),Te=L(mt(te,ie),B,R,T),je=K(_e-ge),fe=K(Tn(Te,ae)),ve=K(hi(Te,ae)),Ne=fe-ve;if(te!=null){let Oe=te<0?J:q,Ee=te<0?q:J;ot?(Ie>0&&k[V]!=null&&ce(jt.get(k[V]),je,ve+Wn(Ie/2),oe,Tn(0,Ne-Ie),Oe,Ee),Ke[V]!=null&&ce(at.get(Ke[V]),je,ve+Wn(Ie/2),oe,Tn(0,Ne-Ie),Oe,Ee)):ce(C,je,ve+Wn(Ie/2),oe,Tn(0,Ne-Ie),Oe,Ee),me(m,_,V,je-Ie/2,ve,oe+Ie,Ne)}}return Ie>0?Pe.stroke=ot?jt:C:ot||(Pe._fill=d.width==0?d._fill:d._stroke??d._fill,Pe.width=0),Pe.fill=ot?at:C,Pe})}function Jg(i,e){const t=mt(e?.alignGaps,0);return(n,s,r,o)=>Vs(n,s,(a,l,c,u,h,f,m,_,v,p,d)=>{[r,o]=Da(c,r,o);let b=a.pxRound,w=ee=>b(f(ee,u,p,_)),M=ee=>b(m(ee,h,d,v)),B,D,L;u.ori==0?(B=Fa,L=Br,D=qd):(B=Oa,L=kr,D=jd);const U=u.dir*(u.ori==0?1:-1);let T=w(l[U==1?r:o]),y=T,R=[],K=[];for(let ee=U==1?r:o;ee>=r&&ee<=o;ee+=U)if(c[ee]!=null){let ue=l[ee],ce=w(ue);R.push(y=ce),K.push(M(c[ee]))}const F={stroke:i(R,K,B,L,D,b),fill:null,clip:null,band:null,gaps:null,flags:Cr},G=F.stroke;let[Z,j]=fh(n,s);if(a.fill!=null||Z!=0){let ee=F.fill=new Path2D(G),Q=a.fillTo(n,s,a.min,a.max,Z),ue=M(Q);L(ee,y,ue),L(ee,T,ue)}if(!a.spanGaps){let ee=[];ee.push(...dh(l,c,r,o,U,w,t)),F.gaps=ee=a.gaps(n,s,r,o,ee),F.clip=Na(ee,u.ori,_,v,p,d)}return j!=0&&(F.band=j==2?[Gi(n,s,r,o,G,-1),Gi(n,s,r,o,G,1)]:Gi(n,s,r,o,G,j)),F})}function Qg(i){return Jg(e_,i)}function e_(i,e,t,n,s,r){const o=i.length;if(o<2)return null;const a=new Path2D;if(t(a,i[0],e[0]),o==2)n(a,i[1],e[1]);else{let l=Array(o),c=Array(o-1),u=Array(o-1),h=Array(o-1);for(let f=0;f<o-1;f++)u[f]=e[f+1]-e[f],h[f]=i[f+1]-i[f],c[f]=u[f]/h[f];l[0]=c[0];for(let f=1;f<o-1;f++)c[f]===0||c[f-1]===0||c[f-1]>0!=c[f]>0?l[f]=0:(l[f]=3*(h[f-1]+h[f])/((2*h[f]+h[f-1])/c[f-1]+(h[f]+2*h[f-1])/c[f]),isFinite(l[f])||(l[f]=0));l[o-1]=c[o-2];for(let f=0;f<o-1;f++)s(a,i[f]+h[f]/3,e[f]+l[f]*h[f]/3,i[f+1]-h[f]/3,e[f+1]-l[f+1]*h[f]/3,i[f+1],e[f+1])}return a}const nc=new Set;function Iu(){for(let i of nc)i.syncRect(!0)}Or&&(Fs(Im,Sr,Iu),Fs(Nm,Sr,Iu,!0),Fs(va,Sr,()=>{_n.pxRatio=vt}));const t_=$d(),n_=Kd();function Nu(i,e,t,n){return(n?[i[0],i[1]].concat(i.slice(2)):[i[0]].concat(i.slice(1))).map((r,o)=>ic(r,o,e,t))}function i_(i,e){return i.map((t,n)=>n==0?{}:qt({},e,t))}function ic(i,e,t,n){return qt({},e==0?t:n,i)}function Jd(i,e,t){return e==null?wr:[e,t]}const s_=Jd;function r_(i,e,t){return e==null?wr:xa(e,t,rh,!0)}function Qd(i,e,t,n){return e==null?wr:La(e,t,i.scales[n].log,!1)}const o_=Qd;function ep(i,e,t,n){return e==null?wr:sh(e,t,i.scales[n].log,!1)}const a_=ep;function l_(i,e,t,n,s){let r=Tn(du(i),du(e)),o=e-i,a=ci(s/n*o,t);do{let l=t[a],c=n*l/o;if(c>=s&&r+(l<5?ds.get(l):0)<=17)return[l,c]}while(++a<t.length);return[0,0]}function Fu(i){let e,t;return i=i.replace(/(\d+)px/,(n,s)=>(e=$t((t=+s)*vt))+"px"),[i,e,t]}function c_(i){i.show&&[i.font,i.labelFont].forEach(e=>{let t=Rt(e[2]*vt,1);e[0]=e[0].replace(/[0-9.]+px/,t+"px"),e[1]=t})}function _n(i,e,t){const n={mode:mt(i.mode,1)},s=n.mode;function r(g,x,A,P){let I=x.valToPct(g);return P+A*(x.dir==-1?1-I:I)}function o(g,x,A,P){let I=x.valToPct(g);return P+A*(x.dir==-1?I:1-I)}function a(g,x,A,P){return x.ori==0?r(g,x,A,P):o(g,x,A,P)}n.valToPosH=r,n.valToPosV=o;let l=!1;n.status=0;const c=n.root=$n(gm);if(i.id!=null&&(c.id=i.id),zn(c,i.class),i.title){let g=$n(xm,c);g.textContent=i.title}const u=li("canvas"),h=n.ctx=u.getContext("2d"),f=$n(Sm,c);Fs("click",f,g=>{g.target===_&&(Dt!=Ks||Bt!=Zs)&&hn.click(n,g)},!0);const m=n.under=$n(Mm,f);f.appendChild(u);const _=n.over=$n(ym,f);i=Ar(i);const v=+mt(i.pxAlign,1),p=Lu(v);(i.plugins||[]).forEach(g=>{g.opts&&(i=g.opts(n,i)||i)});const d=i.ms||.001,b=n.series=s==1?Nu(i.series||[],Tu,Pu,!1):i_(i.series||[null],Ru),w=n.axes=Nu(i.axes||[],bu,Au,!0),M=n.scales={},B=n.bands=i.bands||[];B.forEach(g=>{g.fill=rt(g.fill||null),g.dir=mt(g.dir,-1)});const D=s==2?b[1].facets[0].scale:b[0].scale,L={axes:Qp,series:qn},U=(i.drawOrder||["axes","series"]).map(g=>L[g]);function T(g){const x=g.distr==3?A=>Hi(A>0?A:g.clamp(n,A,g.min,g.max,g.key)):g.distr==4?A=>cl(A,g.asinh):g.distr==100?A=>g.fwd(A):A=>A;return A=>{let P=x(A),{_min:I,_max:Y}=g,se=Y-I;return(P-I)/se}}function y(g){let x=M[g];if(x==null){let A=(i.scales||uo)[g]||uo;if(A.from!=null){y(A.from);let P=qt({},M[A.from],A,{key:g});P.valToPct=T(P),M[g]=P}else{x=M[g]=qt({},g==D?Hd:Xg,A),x.key=g;let P=x.time,I=x.range,Y=os(I);if((g!=D||s==2&&!P)&&(Y&&(I[0]==null||I[1]==null)&&(I={min:I[0]==null?hu:{mode:1,hard:I[0],soft:I[0]},max:I[1]==null?hu:{mode:1,hard:I[1],soft:I[1]}},Y=!1),!Y&&Ia(I))){let se=I;I=(le,de,Ce)=>de==null?wr:xa(de,Ce,se)}x.range=rt(I||(P?s_:g==D?x.distr==3?o_:x.distr==4?a_:Jd:x.distr==3?Qd:x.distr==4?ep:r_)),x.auto=rt(Y?!1:x.auto),x.clamp=rt(x.clamp||Wg),x._min=x._max=null,x.valToPct=T(x)}}}y("x"),y("y"),s==1&&b.forEach(g=>{y(g.scale)}),w.forEach(g=>{y(g.scale)});for(let g in i.scales)y(g);const R=M[D],K=R.distr;let F,G;R.ori==0?(zn(c,_m),F=r,G=o):(zn(c,vm),F=o,G=r);const Z={};for(let g in M){let x=M[g];(x.min!=null||x.max!=null)&&(Z[g]={min:x.min,max:x.max},x.min=x.max=null)}const j=i.tzDate||(g=>new Date($t(g/d))),ee=i.fmtDate||lh,Q=d==1?_g(j):Sg(j),ue=Mu(j,Su(d==1?gg:xg,ee)),ce=Eu(j,yu(yg,ee)),me=[],Se=n.legend=qt({},Tg,i.legend),pe=n.cursor=qt({},Dg,{drag:{y:s==2}},i.cursor),ie=Se.show,ae=pe.show,ge=Se.markers;Se.idxs=me,ge.width=rt(ge.width),ge.dash=rt(ge.dash),ge.stroke=rt(ge.stroke),ge.fill=rt(ge.fill);let oe,ke,Ve,Ie=[],ot=[],Ke,at=!1,k={};if(Se.live){const g=b[1]?b[1].values:null;at=g!=null,Ke=at?g(n,1,0):{_:0};for(let x in Ke)k[x]=nh}if(ie)if(oe=li("table",Cm,c),Ve=li("tbody",null,oe),Se.mount(n,oe),at){ke=li("thead",null,oe,Ve);let g=li("tr",null,ke);li("th",null,g);for(var jt in Ke)li("th",$h,g).textContent=jt}else zn(oe,Pm),Se.live&&zn(oe,Rm);const $e={show:!0},Qe={show:!1};function He(g,x){if(x==0&&(at||!Se.live||s==2))return wr;let A=[],P=li("tr",Dm,Ve,Ve.childNodes[x]);zn(P,g.class),g.show||zn(P,Ds);let I=li("th",null,P);if(ge.show){let le=$n(Lm,I);if(x>0){let de=ge.width(n,x);de&&(le.style.border=de+"px "+ge.dash(n,x)+" "+ge.stroke(n,x)),le.style.background=ge.fill(n,x)}}let Y=$n($h,I);g.label instanceof HTMLElement?Y.appendChild(g.label):Y.textContent=g.label,x>0&&(ge.show||(Y.style.color=g.width>0?ge.stroke(n,x):ge.fill(n,x)),Pe("click",I,le=>{if(pe._lock)return;Kt(le);let de=b.indexOf(g);if((le.ctrlKey||le.metaKey)!=Se.isolate){let Ce=b.some((Re,De)=>De>0&&De!=de&&Re.show);b.forEach((Re,De)=>{De>0&&Si(De,Ce?De==de?$e:Qe:$e,!0,Wt.setSeries)})}else Si(de,{show:!g.show},!0,Wt.setSeries)},!1),Ri&&Pe(tu,I,le=>{pe._lock||(Kt(le),Si(b.indexOf(g),Js,!0,Wt.setSeries))},!1));for(var se in Ke){let le=li("td",Um,P);le.textContent="--",A.push(le)}return[P,A]}const ct=new Map;function Pe(g,x,A,P=!0){const I=ct.get(x)||{},Y=pe.bind[g](n,x,A,P);Y&&(Fs(g,x,I[g]=Y),ct.set(x,I))}function C(g,x,A){const P=ct.get(x)||{};for(let I in P)(g==null||I==g)&&($l(I,x,P[I]),delete P[I]);g==null&&ct.delete(x)}let S=0,q=0,J=0,V=0,te=0,Me=0,_e=te,Te=Me,je=J,fe=V,ve=0,Ne=0,Oe=0,Ee=0;n.bbox={};let tt=!1,Ye=!1,ht=!1,O=!1,xe=!1,ne=!1;function re(g,x,A){(A||g!=n.width||x!=n.height)&&we(g,x),Xs(!1),ht=!0,Ye=!0,Ys()}function we(g,x){n.width=S=J=g,n.height=q=V=x,te=Me=0,nn(),gt();let A=n.bbox;ve=A.left=Cs(te*vt,.5),Ne=A.top=Cs(Me*vt,.5),Oe=A.width=Cs(J*vt,.5),Ee=A.height=Cs(V*vt,.5)}const Ae=3;function Ze(){let g=!1,x=0;for(;!g;){x++;let A=$p(x),P=Jp(x);g=x==Ae||A&&P,g||(we(n.width,n.height),Ye=!0)}}function Ft({width:g,height:x}){re(g,x)}n.setSize=Ft;function nn(){let g=!1,x=!1,A=!1,P=!1;w.forEach((I,Y)=>{if(I.show&&I._show){let{side:se,_size:le}=I,de=se%2,Ce=I.label!=null?I.labelSize:0,Re=le+Ce;Re>0&&(de?(J-=Re,se==3?(te+=Re,P=!0):A=!0):(V-=Re,se==0?(Me+=Re,g=!0):x=!0))}}),_i[0]=g,_i[1]=A,_i[2]=x,_i[3]=P,J-=E[1]+E[3],te+=E[3],V-=E[2]+E[0],Me+=E[0]}function gt(){let g=te+J,x=Me+V,A=te,P=Me;function I(Y,se){switch(Y){case 1:return g+=se,g-se;case 2:return x+=se,x-se;case 3:return A-=se,A+se;case 0:return P-=se,P+se}}w.forEach((Y,se)=>{if(Y.show&&Y._show){let le=Y.side;Y._pos=I(le,Y._size),Y.label!=null&&(Y._lpos=I(le,Y.labelSize))}})}if(pe.dataIdx==null){let g=pe.hover,x=g.skip=new Set(g.skip??[]);x.add(void 0);let A=g.prox=rt(g.prox),P=g.bias??(g.bias=0);pe.dataIdx=(I,Y,se,le)=>{if(Y==0)return se;let de=se,Ce=A(I,Y,se,le)??Ct,Re=Ce>=0&&Ce<Ct,De=R.ori==0?J:V,qe=pe.left,_t=e[0],dt=e[Y];if(x.has(dt[se])){de=null;let it=null,We=null,ze;if(P==0||P==-1)for(ze=se;it==null&&ze-- >0;)x.has(dt[ze])||(it=ze);if(P==0||P==1)for(ze=se;We==null&&ze++<dt.length;)x.has(dt[ze])||(We=ze);if(it!=null||We!=null)if(Re){let Ut=it==null?-1/0:F(_t[it],R,De,0),zt=We==null?1/0:F(_t[We],R,De,0),ln=qe-Ut,bt=zt-qe;ln<=bt?ln<=Ce&&(de=it):bt<=Ce&&(de=We)}else de=We==null?it:it==null?We:se-it<=We-se?it:We}else Re&&Jt(qe-F(_t[se],R,De,0))>Ce&&(de=null);return de}}const Kt=g=>{pe.event=g};pe.idxs=me,pe._lock=!1;let Pt=pe.points;Pt.show=rt(Pt.show),Pt.size=rt(Pt.size),Pt.stroke=rt(Pt.stroke),Pt.width=rt(Pt.width),Pt.fill=rt(Pt.fill);const Un=n.focus=qt({},i.focus||{alpha:.3},pe.focus),Ri=Un.prox>=0,Rn=Ri&&Pt.one;let un=[],Pi=[],Di=[];function gs(g,x){let A=Pt.show(n,x);if(A instanceof HTMLElement)return zn(A,Am),zn(A,g.class),bi(A,-10,-10,J,V),_.insertBefore(A,un[x]),A}function Wr(g,x){if(s==1||x>0){let A=s==1&&M[g.scale].time,P=g.value;g.value=A?gu(P)?Eu(j,yu(P,ee)):P||ce:P||Vg,g.label=g.label||(A?Ug:Lg)}if(Rn||x>0){g.width=g.width==null?1:g.width,g.paths=g.paths||t_||Xm,g.fillTo=rt(g.fillTo||Yg),g.pxAlign=+mt(g.pxAlign,v),g.pxRound=Lu(g.pxAlign),g.stroke=rt(g.stroke||null),g.fill=rt(g.fill||null),g._stroke=g._fill=g._paths=g._focus=null;let A=Hg(Tn(1,g.width),1),P=g.points=qt({},{size:A,width:Tn(1,A*.2),stroke:g.stroke,space:A*2,paths:n_,_stroke:null,_fill:null},g.points);P.show=rt(P.show),P.filter=rt(P.filter),P.fill=rt(P.fill),P.stroke=rt(P.stroke),P.paths=rt(P.paths),P.pxAlign=g.pxAlign}if(ie){let A=He(g,x);Ie.splice(x,0,A[0]),ot.splice(x,0,A[1]),Se.values.push(null)}if(ae){me.splice(x,0,null);let A=null;Rn?x==0&&(A=gs(g,x)):x>0&&(A=gs(g,x)),un.splice(x,0,A),Pi.splice(x,0,0),Di.splice(x,0,0)}an("addSeries",x)}function Gs(g,x){x=x??b.length,g=s==1?ic(g,x,Tu,Pu):ic(g,x,{},Ru),b.splice(x,0,g),Wr(b[x],x)}n.addSeries=Gs;function Co(g){if(b.splice(g,1),ie){Se.values.splice(g,1),ot.splice(g,1);let x=Ie.splice(g,1)[0];C(null,x.firstChild),x.remove()}ae&&(me.splice(g,1),un.splice(g,1)[0].remove(),Pi.splice(g,1),Di.splice(g,1)),an("delSeries",g)}n.delSeries=Co;const _i=[!1,!1,!1,!1];function Xa(g,x){if(g._show=g.show,g.show){let A=g.side%2,P=M[g.scale];P==null&&(g.scale=A?b[1].scale:D,P=M[g.scale]);let I=P.time;g.size=rt(g.size),g.space=rt(g.space),g.rotate=rt(g.rotate),os(g.incrs)&&g.incrs.forEach(se=>{!ds.has(se)&&ds.set(se,Ed(se))}),g.incrs=rt(g.incrs||(P.distr==2?dg:I?d==1?mg:vg:Rs)),g.splits=rt(g.splits||(I&&P.distr==1?Q:P.distr==3?Ql:P.distr==4?Fg:Ng)),g.stroke=rt(g.stroke),g.grid.stroke=rt(g.grid.stroke),g.ticks.stroke=rt(g.ticks.stroke),g.border.stroke=rt(g.border.stroke);let Y=g.values;g.values=os(Y)&&!os(Y[0])?rt(Y):I?os(Y)?Mu(j,Su(Y,ee)):gu(Y)?Mg(j,Y):Y||ue:Y||Ig,g.filter=rt(g.filter||(P.distr>=3&&P.log==10?kg:P.distr==3&&P.log==2?zg:Md)),g.font=Fu(g.font),g.labelFont=Fu(g.labelFont),g._size=g.size(n,null,x,0),g._space=g._rotate=g._incrs=g._found=g._splits=g._values=null,g._size>0&&(_i[x]=!0,g._el=$n(Em,f))}}function _s(g,x,A,P){let[I,Y,se,le]=A,de=x%2,Ce=0;return de==0&&(le||Y)&&(Ce=x==0&&!I||x==2&&!se?$t(bu.size/3):0),de==1&&(I||se)&&(Ce=x==1&&!Y||x==3&&!le?$t(Au.size/2):0),Ce}const Ro=n.padding=(i.padding||[_s,_s,_s,_s]).map(g=>rt(mt(g,_s))),E=n._padding=Ro.map((g,x)=>g(n,x,_i,0));let N,W=null,X=null;const z=s==1?b[0].idxs:null;let he=null,ye=!1;function Fe(g,x){if(e=g??[],n.data=n._data=e,s==2){N=0;for(let A=1;A<b.length;A++)N+=e[A][0].length}else{e.length==0&&(n.data=n._data=e=[[]]),he=e[0],N=he.length;let A=e;if(K==2){A=e.slice();let P=A[0]=Array(N);for(let I=0;I<N;I++)P[I]=I}n._data=e=A}if(Xs(!0),an("setData"),K==2&&(ht=!0),x!==!1){let A=R;A.auto(n,ye)?Le():Zi(D,A.min,A.max),O=O||pe.left>=0,ne=!0,Ys()}}n.setData=Fe;function Le(){ye=!0;let g,x;s==1&&(N>0?(W=z[0]=0,X=z[1]=N-1,g=e[0][W],x=e[0][X],K==2?(g=W,x=X):g==x&&(K==3?[g,x]=La(g,g,R.log,!1):K==4?[g,x]=sh(g,g,R.log,!1):R.time?x=g+$t(86400/d):[g,x]=xa(g,x,rh,!0))):(W=z[0]=g=null,X=z[1]=x=null)),Zi(D,g,x)}let Ge,Xe,Ue,st,St,yt,sn,lt,Be,Ot;function ut(g,x,A,P,I,Y){g??(g=Qh),A??(A=ah),P??(P="butt"),I??(I=Qh),Y??(Y="round"),g!=Ge&&(h.strokeStyle=Ge=g),I!=Xe&&(h.fillStyle=Xe=I),x!=Ue&&(h.lineWidth=Ue=x),Y!=St&&(h.lineJoin=St=Y),P!=yt&&(h.lineCap=yt=P),A!=st&&h.setLineDash(st=A)}function Pn(g,x,A,P){x!=Xe&&(h.fillStyle=Xe=x),g!=sn&&(h.font=sn=g),A!=lt&&(h.textAlign=lt=A),P!=Be&&(h.textBaseline=Be=P)}function vi(g,x,A,P,I=0){if(P.length>0&&g.auto(n,ye)&&(x==null||x.min==null)){let Y=mt(W,0),se=mt(X,P.length-1),le=A.min==null?km(P,Y,se,I,g.distr==3):[A.min,A.max];g.min=hi(g.min,A.min=le[0]),g.max=Tn(g.max,A.max=le[1])}}const fn={min:null,max:null};function vs(){for(let P in M){let I=M[P];Z[P]==null&&(I.min==null||Z[D]!=null&&I.auto(n,ye))&&(Z[P]=fn)}for(let P in M){let I=M[P];Z[P]==null&&I.from!=null&&Z[I.from]!=null&&(Z[P]=fn)}Z[D]!=null&&Xs(!0);let g={};for(let P in Z){let I=Z[P];if(I!=null){let Y=g[P]=Ar(M[P],jm);if(I.min!=null)qt(Y,I);else if(P!=D||s==2)if(N==0&&Y.from==null){let se=Y.range(n,null,null,P);Y.min=se[0],Y.max=se[1]}else Y.min=Ct,Y.max=-Ct}}if(N>0){b.forEach((P,I)=>{if(s==1){let Y=P.scale,se=Z[Y];if(se==null)return;let le=g[Y];if(I==0){let de=le.range(n,le.min,le.max,Y);le.min=de[0],le.max=de[1],W=ci(le.min,e[0]),X=ci(le.max,e[0]),X-W>1&&(e[0][W]<le.min&&W++,e[0][X]>le.max&&X--),P.min=he[W],P.max=he[X]}else P.show&&P.auto&&vi(le,se,P,e[I],P.sorted);P.idxs[0]=W,P.idxs[1]=X}else if(I>0&&P.show&&P.auto){let[Y,se]=P.facets,le=Y.scale,de=se.scale,[Ce,Re]=e[I],De=g[le],qe=g[de];De!=null&&vi(De,Z[le],Y,Ce,Y.sorted),qe!=null&&vi(qe,Z[de],se,Re,se.sorted),P.min=se.min,P.max=se.max}});for(let P in g){let I=g[P],Y=Z[P];if(I.from==null&&(Y==null||Y.min==null)){let se=I.range(n,I.min==Ct?null:I.min,I.max==-Ct?null:I.max,P);I.min=se[0],I.max=se[1]}}}for(let P in g){let I=g[P];if(I.from!=null){let Y=g[I.from];if(Y.min==null)I.min=I.max=null;else{let se=I.range(n,Y.min,Y.max,P);I.min=se[0],I.max=se[1]}}}let x={},A=!1;for(let P in g){let I=g[P],Y=M[P];if(Y.min!=I.min||Y.max!=I.max){Y.min=I.min,Y.max=I.max;let se=Y.distr;Y._min=se==3?Hi(Y.min):se==4?cl(Y.min,Y.asinh):se==100?Y.fwd(Y.min):Y.min,Y._max=se==3?Hi(Y.max):se==4?cl(Y.max,Y.asinh):se==100?Y.fwd(Y.max):Y.max,x[P]=A=!0}}if(A){b.forEach((P,I)=>{s==2?I>0&&x.y&&(P._paths=null):x[P.scale]&&(P._paths=null)});for(let P in x)ht=!0,an("setScale",P);ae&&pe.left>=0&&(O=ne=!0)}for(let P in Z)Z[P]=null}function At(g){let x=Jl(W-1,0,N-1),A=Jl(X+1,0,N-1);for(;g[x]==null&&x>0;)x--;for(;g[A]==null&&A<N-1;)A++;return[x,A]}function qn(){if(N>0){let g=b.some(x=>x._focus)&&Ot!=Un.alpha;g&&(h.globalAlpha=Ot=Un.alpha),b.forEach((x,A)=>{if(A>0&&x.show&&(ji(A,!1),ji(A,!0),x._paths==null)){let P=Ot;Ot!=x.alpha&&(h.globalAlpha=Ot=x.alpha);let I=s==2?[0,e[A][0].length-1]:At(e[A]);x._paths=x.paths(n,A,I[0],I[1]),Ot!=P&&(h.globalAlpha=Ot=P)}}),b.forEach((x,A)=>{if(A>0&&x.show){let P=Ot;Ot!=x.alpha&&(h.globalAlpha=Ot=x.alpha),x._paths!=null&&xn(A,!1);{let I=x._paths!=null?x._paths.gaps:null,Y=x.points.show(n,A,W,X,I),se=x.points.filter(n,A,Y,I);(Y||se)&&(x.points._paths=x.points.paths(n,A,W,X,se),xn(A,!0))}Ot!=P&&(h.globalAlpha=Ot=P),an("drawSeries",A)}}),g&&(h.globalAlpha=Ot=1)}}function ji(g,x){let A=x?b[g].points:b[g];A._stroke=A.stroke(n,g),A._fill=A.fill(n,g)}function xn(g,x){let A=x?b[g].points:b[g],{stroke:P,fill:I,clip:Y,flags:se,_stroke:le=A._stroke,_fill:de=A._fill,_width:Ce=A.width}=A._paths;Ce=Rt(Ce*vt,3);let Re=null,De=Ce%2/2;x&&de==null&&(de=Ce>0?"#fff":le);let qe=A.pxAlign==1&&De>0;if(qe&&h.translate(De,De),!x){let _t=ve-Ce/2,dt=Ne-Ce/2,it=Oe+Ce,We=Ee+Ce;Re=new Path2D,Re.rect(_t,dt,it,We)}x?Ws(le,Ce,A.dash,A.cap,de,P,I,se,Y):xi(g,le,Ce,A.dash,A.cap,de,P,I,se,Re,Y),qe&&h.translate(-De,-De)}function xi(g,x,A,P,I,Y,se,le,de,Ce,Re){let De=!1;de!=0&&B.forEach((qe,_t)=>{if(qe.series[0]==g){let dt=b[qe.series[1]],it=e[qe.series[1]],We=(dt._paths||uo).band;os(We)&&(We=qe.dir==1?We[0]:We[1]);let ze,Ut=null;dt.show&&We&&Vm(it,W,X)?(Ut=qe.fill(n,_t)||Y,ze=dt._paths.clip):We=null,Ws(x,A,P,I,Ut,se,le,de,Ce,Re,ze,We),De=!0}}),De||Ws(x,A,P,I,Y,se,le,de,Ce,Re)}const ti=Cr|tc;function Ws(g,x,A,P,I,Y,se,le,de,Ce,Re,De){ut(g,x,A,P,I),(de||Ce||De)&&(h.save(),de&&h.clip(de),Ce&&h.clip(Ce)),De?(le&ti)==ti?(h.clip(De),Re&&h.clip(Re),Do(I,se),Po(g,Y,x)):le&tc?(Do(I,se),h.clip(De),Po(g,Y,x)):le&Cr&&(h.save(),h.clip(De),Re&&h.clip(Re),Do(I,se),h.restore(),Po(g,Y,x)):(Do(I,se),Po(g,Y,x)),(de||Ce||De)&&h.restore()}function Po(g,x,A){A>0&&(x instanceof Map?x.forEach((P,I)=>{h.strokeStyle=Ge=I,h.stroke(P)}):x!=null&&g&&h.stroke(x))}function Do(g,x){x instanceof Map?x.forEach((A,P)=>{h.fillStyle=Xe=P,h.fill(A)}):x!=null&&g&&h.fill(x)}function Zp(g,x,A,P){let I=w[g],Y;if(P<=0)Y=[0,0];else{let se=I._space=I.space(n,g,x,A,P),le=I._incrs=I.incrs(n,g,x,A,P,se);Y=l_(x,A,le,P,se)}return I._found=Y}function Ya(g,x,A,P,I,Y,se,le,de,Ce){let Re=se%2/2;v==1&&h.translate(Re,Re),ut(le,se,de,Ce,le),h.beginPath();let De,qe,_t,dt,it=I+(P==0||P==3?-Y:Y);A==0?(qe=I,dt=it):(De=I,_t=it);for(let We=0;We<g.length;We++)x[We]!=null&&(A==0?De=_t=g[We]:qe=dt=g[We],h.moveTo(De,qe),h.lineTo(_t,dt));h.stroke(),v==1&&h.translate(-Re,-Re)}function $p(g){let x=!0;return w.forEach((A,P)=>{if(!A.show)return;let I=M[A.scale];if(I.min==null){A._show&&(x=!1,A._show=!1,Xs(!1));return}else A._show||(x=!1,A._show=!0,Xs(!1));let Y=A.side,se=Y%2,{min:le,max:de}=I,[Ce,Re]=Zp(P,le,de,se==0?J:V);if(Re==0)return;let De=I.distr==2,qe=A._splits=A.splits(n,P,le,de,Ce,Re,De),_t=I.distr==2?qe.map(ze=>he[ze]):qe,dt=I.distr==2?he[qe[1]]-he[qe[0]]:Ce,it=A._values=A.values(n,A.filter(n,_t,P,Re,dt),P,Re,dt);A._rotate=Y==2?A.rotate(n,it,P,Re):0;let We=A._size;A._size=Qn(A.size(n,it,P,g)),We!=null&&A._size!=We&&(x=!1)}),x}function Jp(g){let x=!0;return Ro.forEach((A,P)=>{let I=A(n,P,_i,g);I!=E[P]&&(x=!1),E[P]=I}),x}function Qp(){for(let g=0;g<w.length;g++){let x=w[g];if(!x.show||!x._show)continue;let A=x.side,P=A%2,I,Y,se=x.stroke(n,g),le=A==0||A==3?-1:1,[de,Ce]=x._found;if(x.label!=null){let Mn=x.labelGap*le,Fn=$t((x._lpos+Mn)*vt);Pn(x.labelFont[0],se,"center",A==2?Zr:Jh),h.save(),P==1?(I=Y=0,h.translate(Fn,$t(Ne+Ee/2)),h.rotate((A==3?-ua:ua)/2)):(I=$t(ve+Oe/2),Y=Fn);let Ms=xd(x.label)?x.label(n,g,de,Ce):x.label;h.fillText(Ms,I,Y),h.restore()}if(Ce==0)continue;let Re=M[x.scale],De=P==0?Oe:Ee,qe=P==0?ve:Ne,_t=x._splits,dt=Re.distr==2?_t.map(Mn=>he[Mn]):_t,it=Re.distr==2?he[_t[1]]-he[_t[0]]:de,We=x.ticks,ze=x.border,Ut=We.show?We.size:0,zt=$t(Ut*vt),ln=$t((x.alignTo==2?x._size-Ut-x.gap:x.gap)*vt),bt=x._rotate*-ua/180,Vt=p(x._pos*vt),In=(zt+ln)*le,Sn=Vt+In;Y=P==0?Sn:0,I=P==1?Sn:0;let jn=x.font[0],ni=x.align==1?tr:x.align==2?ol:bt>0?tr:bt<0?ol:P==0?"center":A==3?ol:tr,yi=bt||P==1?"middle":A==2?Zr:Jh;Pn(jn,se,ni,yi);let Nn=x.font[1]*x.lineGap,Kn=_t.map(Mn=>p(a(Mn,Re,De,qe))),ii=x._values;for(let Mn=0;Mn<ii.length;Mn++){let Fn=ii[Mn];if(Fn!=null){P==0?I=Kn[Mn]:Y=Kn[Mn],Fn=""+Fn;let Ms=Fn.indexOf(`
`)==-1?[Fn]:Fn.split(/\n/gm);for(let yn=0;yn<Ms.length;yn++){let jh=Ms[yn];bt?(h.save(),h.translate(I,Y+yn*Nn),h.rotate(bt),h.fillText(jh,0,0),h.restore()):h.fillText(jh,I,Y+yn*Nn)}}}We.show&&Ya(Kn,We.filter(n,dt,g,Ce,it),P,A,Vt,zt,Rt(We.width*vt,3),We.stroke(n,g),We.dash,We.cap);let Ei=x.grid;Ei.show&&Ya(Kn,Ei.filter(n,dt,g,Ce,it),P,P==0?2:1,P==0?Ne:ve,P==0?Ee:Oe,Rt(Ei.width*vt,3),Ei.stroke(n,g),Ei.dash,Ei.cap),ze.show&&Ya([Vt],[1],P==0?1:0,P==0?1:2,P==1?Ne:ve,P==1?Ee:Oe,Rt(ze.width*vt,3),ze.stroke(n,g),ze.dash,ze.cap)}an("drawAxes")}function Xs(g){b.forEach((x,A)=>{A>0&&(x._paths=null,g&&(s==1?(x.min=null,x.max=null):x.facets.forEach(P=>{P.min=null,P.max=null})))})}let Lo=!1,qa=!1,Xr=[];function em(){qa=!1;for(let g=0;g<Xr.length;g++)an(...Xr[g]);Xr.length=0}function Ys(){Lo||(tg(Ph),Lo=!0)}function tm(g,x=!1){Lo=!0,qa=x,g(n),Ph(),x&&Xr.length>0&&queueMicrotask(em)}n.batch=tm;function Ph(){if(tt&&(vs(),tt=!1),ht&&(Ze(),ht=!1),Ye){if(It(m,tr,te),It(m,Zr,Me),It(m,ro,J),It(m,oo,V),It(_,tr,te),It(_,Zr,Me),It(_,ro,J),It(_,oo,V),It(f,ro,S),It(f,oo,q),u.width=$t(S*vt),u.height=$t(q*vt),w.forEach(({_el:g,_show:x,_size:A,_pos:P,side:I})=>{if(g!=null)if(x){let Y=I===3||I===0?A:0,se=I%2==1;It(g,se?"left":"top",P-Y),It(g,se?"width":"height",A),It(g,se?"top":"left",se?Me:te),It(g,se?"height":"width",se?V:J),Zl(g,Ds)}else zn(g,Ds)}),Ge=Xe=Ue=St=yt=sn=lt=Be=st=null,Ot=1,jr(!0),te!=_e||Me!=Te||J!=je||V!=fe){Xs(!1);let g=J/je,x=V/fe;if(ae&&!O&&pe.left>=0){pe.left*=g,pe.top*=x,qs&&bi(qs,$t(pe.left),0,J,V),js&&bi(js,0,$t(pe.top),J,V);for(let A=0;A<un.length;A++){let P=un[A];P!=null&&(Pi[A]*=g,Di[A]*=x,bi(P,Qn(Pi[A]),Qn(Di[A]),J,V))}}if(Lt.show&&!xe&&Lt.left>=0&&Lt.width>0){Lt.left*=g,Lt.width*=g,Lt.top*=x,Lt.height*=x;for(let A in Qa)It($s,A,Lt[A])}_e=te,Te=Me,je=J,fe=V}an("setSize"),Ye=!1}S>0&&q>0&&(h.clearRect(0,0,u.width,u.height),an("drawClear"),U.forEach(g=>g()),an("draw")),Lt.show&&xe&&(Uo(Lt),xe=!1),ae&&O&&(Ss(null,!0,!1),O=!1),Se.show&&Se.live&&ne&&($a(),ne=!1),l||(l=!0,n.status=1,an("ready")),ye=!1,Lo=!1}n.redraw=(g,x)=>{ht=x||!1,g!==!1?Zi(D,R.min,R.max):Ys()};function ja(g,x){let A=M[g];if(A.from==null){if(N==0){let P=A.range(n,x.min,x.max,g);x.min=P[0],x.max=P[1]}if(x.min>x.max){let P=x.min;x.min=x.max,x.max=P}if(N>1&&x.min!=null&&x.max!=null&&x.max-x.min<1e-16)return;g==D&&A.distr==2&&N>0&&(x.min=ci(x.min,e[0]),x.max=ci(x.max,e[0]),x.min==x.max&&x.max++),Z[g]=x,tt=!0,Ys()}}n.setScale=ja;let Ka,Za,qs,js,Dh,Lh,Ks,Zs,Uh,Ih,Dt,Bt,Ki=!1;const hn=pe.drag;let rn=hn.x,on=hn.y;ae&&(pe.x&&(Ka=$n(Tm,_)),pe.y&&(Za=$n(wm,_)),R.ori==0?(qs=Ka,js=Za):(qs=Za,js=Ka),Dt=pe.left,Bt=pe.top);const Lt=n.select=qt({show:!0,over:!0,left:0,width:0,top:0,height:0},i.select),$s=Lt.show?$n(bm,Lt.over?_:m):null;function Uo(g,x){if(Lt.show){for(let A in g)Lt[A]=g[A],A in Qa&&It($s,A,g[A]);x!==!1&&an("setSelect")}}n.setSelect=Uo;function nm(g){if(b[g].show)ie&&Zl(Ie[g],Ds);else if(ie&&zn(Ie[g],Ds),ae){let A=Rn?un[0]:un[g];A!=null&&bi(A,-10,-10,J,V)}}function Zi(g,x,A){ja(g,{min:x,max:A})}function Si(g,x,A,P){x.focus!=null&&am(g),x.show!=null&&b.forEach((I,Y)=>{Y>0&&(g==Y||g==null)&&(I.show=x.show,nm(Y),s==2?(Zi(I.facets[0].scale,null,null),Zi(I.facets[1].scale,null,null)):Zi(I.scale,null,null),Ys())}),A!==!1&&an("setSeries",g,x),P&&Kr("setSeries",n,g,x)}n.setSeries=Si;function im(g,x){qt(B[g],x)}function sm(g,x){g.fill=rt(g.fill||null),g.dir=mt(g.dir,-1),x=x??B.length,B.splice(x,0,g)}function rm(g){g==null?B.length=0:B.splice(g,1)}n.addBand=sm,n.setBand=im,n.delBand=rm;function om(g,x){b[g].alpha=x,ae&&un[g]!=null&&(un[g].style.opacity=x),ie&&Ie[g]&&(Ie[g].style.opacity=x)}let Li,$i,xs;const Js={focus:!0};function am(g){if(g!=xs){let x=g==null,A=Un.alpha!=1;b.forEach((P,I)=>{if(s==1||I>0){let Y=x||I==0||I==g;P._focus=x?null:Y,A&&om(I,Y?1:Un.alpha)}}),xs=g,A&&Ys()}}ie&&Ri&&Pe(nu,oe,g=>{pe._lock||(Kt(g),xs!=null&&Si(null,Js,!0,Wt.setSeries))});function Mi(g,x,A){let P=M[x];A&&(g=g/vt-(P.ori==1?Me:te));let I=J;P.ori==1&&(I=V,g=I-g),P.dir==-1&&(g=I-g);let Y=P._min,se=P._max,le=g/I,de=Y+(se-Y)*le,Ce=P.distr;return Ce==3?Tr(10,de):Ce==4?Gm(de,P.asinh):Ce==100?P.bwd(de):de}function lm(g,x){let A=Mi(g,D,x);return ci(A,e[0],W,X)}n.valToIdx=g=>ci(g,e[0]),n.posToIdx=lm,n.posToVal=Mi,n.valToPos=(g,x,A)=>M[x].ori==0?r(g,M[x],A?Oe:J,A?ve:0):o(g,M[x],A?Ee:V,A?Ne:0),n.setCursor=(g,x,A)=>{Dt=g.left,Bt=g.top,Ss(null,x,A)};function Nh(g,x){It($s,tr,Lt.left=g),It($s,ro,Lt.width=x)}function Fh(g,x){It($s,Zr,Lt.top=g),It($s,oo,Lt.height=x)}let Yr=R.ori==0?Nh:Fh,qr=R.ori==1?Nh:Fh;function cm(){if(ie&&Se.live)for(let g=s==2?1:0;g<b.length;g++){if(g==0&&at)continue;let x=Se.values[g],A=0;for(let P in x)ot[g][A++].firstChild.nodeValue=x[P]}}function $a(g,x){if(g!=null&&(g.idxs?g.idxs.forEach((A,P)=>{me[P]=A}):qm(g.idx)||me.fill(g.idx),Se.idx=me[0]),ie&&Se.live){for(let A=0;A<b.length;A++)(A>0||s==1&&!at)&&hm(A,me[A]);cm()}ne=!1,x!==!1&&an("setLegend")}n.setLegend=$a;function hm(g,x){let A=b[g],P=g==0&&K==2?he:e[g],I;at?I=A.values(n,g,x)??k:(I=A.value(n,x==null?null:P[x],g,x),I=I==null?k:{_:I}),Se.values[g]=I}function Ss(g,x,A){Uh=Dt,Ih=Bt,[Dt,Bt]=pe.move(n,Dt,Bt),pe.left=Dt,pe.top=Bt,ae&&(qs&&bi(qs,$t(Dt),0,J,V),js&&bi(js,0,$t(Bt),J,V));let P,I=W>X;Li=Ct,$i=null;let Y=R.ori==0?J:V,se=R.ori==1?J:V;if(Dt<0||N==0||I){P=pe.idx=null;for(let le=0;le<b.length;le++){let de=un[le];de!=null&&bi(de,-10,-10,J,V)}Ri&&Si(null,Js,!0,g==null&&Wt.setSeries),Se.live&&(me.fill(P),ne=!0)}else{let le,de,Ce;s==1&&(le=R.ori==0?Dt:Bt,de=Mi(le,D),P=pe.idx=ci(de,e[0],W,X),Ce=F(e[0][P],R,Y,0));let Re=-10,De=-10,qe=0,_t=0,dt=!0,it="",We="";for(let ze=s==2?1:0;ze<b.length;ze++){let Ut=b[ze],zt=me[ze],ln=zt==null?null:s==1?e[ze][zt]:e[ze][1][zt],bt=pe.dataIdx(n,ze,P,de),Vt=bt==null?null:s==1?e[ze][bt]:e[ze][1][bt];if(ne=ne||Vt!=ln||bt!=zt,me[ze]=bt,ze>0&&Ut.show){let In=bt==null?-10:bt==P?Ce:F(s==1?e[0][bt]:e[ze][0][bt],R,Y,0),Sn=Vt==null?-10:G(Vt,s==1?M[Ut.scale]:M[Ut.facets[1].scale],se,0);if(Ri&&Vt!=null){let jn=R.ori==1?Dt:Bt,ni=Jt(Un.dist(n,ze,bt,Sn,jn));if(ni<Li){let yi=Un.bias;if(yi!=0){let Nn=Mi(jn,Ut.scale),Kn=Vt>=0?1:-1,ii=Nn>=0?1:-1;ii==Kn&&(ii==1?yi==1?Vt>=Nn:Vt<=Nn:yi==1?Vt<=Nn:Vt>=Nn)&&(Li=ni,$i=ze)}else Li=ni,$i=ze}}if(ne||Rn){let jn,ni;R.ori==0?(jn=In,ni=Sn):(jn=Sn,ni=In);let yi,Nn,Kn,ii,Ei,Mn,Fn=!0,Ms=Pt.bbox;if(Ms!=null){Fn=!1;let yn=Ms(n,ze);Kn=yn.left,ii=yn.top,yi=yn.width,Nn=yn.height}else Kn=jn,ii=ni,yi=Nn=Pt.size(n,ze);if(Mn=Pt.fill(n,ze),Ei=Pt.stroke(n,ze),Rn)ze==$i&&Li<=Un.prox&&(Re=Kn,De=ii,qe=yi,_t=Nn,dt=Fn,it=Mn,We=Ei);else{let yn=un[ze];yn!=null&&(Pi[ze]=Kn,Di[ze]=ii,cu(yn,yi,Nn,Fn),au(yn,Mn,Ei),bi(yn,Qn(Kn),Qn(ii),J,V))}}}}if(Rn){let ze=Un.prox,Ut=xs==null?Li<=ze:Li>ze||$i!=xs;if(ne||Ut){let zt=un[0];zt!=null&&(Pi[0]=Re,Di[0]=De,cu(zt,qe,_t,dt),au(zt,it,We),bi(zt,Qn(Re),Qn(De),J,V))}}}if(Lt.show&&Ki)if(g!=null){let[le,de]=Wt.scales,[Ce,Re]=Wt.match,[De,qe]=g.cursor.sync.scales,_t=g.cursor.drag;if(rn=_t._x,on=_t._y,rn||on){let{left:dt,top:it,width:We,height:ze}=g.select,Ut=g.scales[De].ori,zt=g.posToVal,ln,bt,Vt,In,Sn,jn=le!=null&&Ce(le,De),ni=de!=null&&Re(de,qe);jn&&rn?(Ut==0?(ln=dt,bt=We):(ln=it,bt=ze),Vt=M[le],In=F(zt(ln,De),Vt,Y,0),Sn=F(zt(ln+bt,De),Vt,Y,0),Yr(hi(In,Sn),Jt(Sn-In))):Yr(0,Y),ni&&on?(Ut==1?(ln=dt,bt=We):(ln=it,bt=ze),Vt=M[de],In=G(zt(ln,qe),Vt,se,0),Sn=G(zt(ln+bt,qe),Vt,se,0),qr(hi(In,Sn),Jt(Sn-In))):qr(0,se)}else el()}else{let le=Jt(Uh-Dh),de=Jt(Ih-Lh);if(R.ori==1){let qe=le;le=de,de=qe}rn=hn.x&&le>=hn.dist,on=hn.y&&de>=hn.dist;let Ce=hn.uni;Ce!=null?rn&&on&&(rn=le>=Ce,on=de>=Ce,!rn&&!on&&(de>le?on=!0:rn=!0)):hn.x&&hn.y&&(rn||on)&&(rn=on=!0);let Re,De;rn&&(R.ori==0?(Re=Ks,De=Dt):(Re=Zs,De=Bt),Yr(hi(Re,De),Jt(De-Re)),on||qr(0,se)),on&&(R.ori==1?(Re=Ks,De=Dt):(Re=Zs,De=Bt),qr(hi(Re,De),Jt(De-Re)),rn||Yr(0,Y)),!rn&&!on&&(Yr(0,0),qr(0,0))}if(hn._x=rn,hn._y=on,g==null){if(A){if(qh!=null){let[le,de]=Wt.scales;Wt.values[0]=le!=null?Mi(R.ori==0?Dt:Bt,le):null,Wt.values[1]=de!=null?Mi(R.ori==1?Dt:Bt,de):null}Kr(al,n,Dt,Bt,J,V,P)}if(Ri){let le=A&&Wt.setSeries,de=Un.prox;xs==null?Li<=de&&Si($i,Js,!0,le):Li>de?Si(null,Js,!0,le):$i!=xs&&Si($i,Js,!0,le)}}ne&&(Se.idx=P,$a()),x!==!1&&an("setCursor")}let Ji=null;Object.defineProperty(n,"rect",{get(){return Ji==null&&jr(!1),Ji}});function jr(g=!1){g?Ji=null:(Ji=_.getBoundingClientRect(),an("syncRect",Ji))}function Oh(g,x,A,P,I,Y,se){pe._lock||Ki&&g!=null&&g.movementX==0&&g.movementY==0||(Ja(g,x,A,P,I,Y,se,!1,g!=null),g!=null?Ss(null,!0,!0):Ss(x,!0,!1))}function Ja(g,x,A,P,I,Y,se,le,de){if(Ji==null&&jr(!1),Kt(g),g!=null)A=g.clientX-Ji.left,P=g.clientY-Ji.top;else{if(A<0||P<0){Dt=-10,Bt=-10;return}let[Ce,Re]=Wt.scales,De=x.cursor.sync,[qe,_t]=De.values,[dt,it]=De.scales,[We,ze]=Wt.match,Ut=x.axes[0].side%2==1,zt=R.ori==0?J:V,ln=R.ori==1?J:V,bt=Ut?Y:I,Vt=Ut?I:Y,In=Ut?P:A,Sn=Ut?A:P;if(dt!=null?A=We(Ce,dt)?a(qe,M[Ce],zt,0):-10:A=zt*(In/bt),it!=null?P=ze(Re,it)?a(_t,M[Re],ln,0):-10:P=ln*(Sn/Vt),R.ori==1){let jn=A;A=P,P=jn}}de&&(x==null||x.cursor.event.type==al)&&((A<=1||A>=J-1)&&(A=Cs(A,J)),(P<=1||P>=V-1)&&(P=Cs(P,V))),le?(Dh=A,Lh=P,[Ks,Zs]=pe.move(n,A,P)):(Dt=A,Bt=P)}const Qa={width:0,height:0,left:0,top:0};function el(){Uo(Qa,!1)}let Bh,kh,zh,Vh;function Hh(g,x,A,P,I,Y,se){Ki=!0,rn=on=hn._x=hn._y=!1,Ja(g,x,A,P,I,Y,se,!0,!1),g!=null&&(Pe(ll,jl,Gh,!1),Kr(eu,n,Ks,Zs,J,V,null));let{left:le,top:de,width:Ce,height:Re}=Lt;Bh=le,kh=de,zh=Ce,Vh=Re}function Gh(g,x,A,P,I,Y,se){Ki=hn._x=hn._y=!1,Ja(g,x,A,P,I,Y,se,!1,!0);let{left:le,top:de,width:Ce,height:Re}=Lt,De=Ce>0||Re>0,qe=Bh!=le||kh!=de||zh!=Ce||Vh!=Re;if(De&&qe&&Uo(Lt),hn.setScale&&De&&qe){let _t=le,dt=Ce,it=de,We=Re;if(R.ori==1&&(_t=de,dt=Re,it=le,We=Ce),rn&&Zi(D,Mi(_t,D),Mi(_t+dt,D)),on)for(let ze in M){let Ut=M[ze];ze!=D&&Ut.from==null&&Ut.min!=Ct&&Zi(ze,Mi(it+We,ze),Mi(it,ze))}el()}else pe.lock&&(pe._lock=!pe._lock,Ss(x,!0,g!=null));g!=null&&(C(ll,jl),Kr(ll,n,Dt,Bt,J,V,null))}function um(g,x,A,P,I,Y,se){if(pe._lock)return;Kt(g);let le=Ki;if(Ki){let de=!0,Ce=!0,Re=10,De,qe;R.ori==0?(De=rn,qe=on):(De=on,qe=rn),De&&qe&&(de=Dt<=Re||Dt>=J-Re,Ce=Bt<=Re||Bt>=V-Re),De&&de&&(Dt=Dt<Ks?0:J),qe&&Ce&&(Bt=Bt<Zs?0:V),Ss(null,!0,!0),Ki=!1}Dt=-10,Bt=-10,me.fill(null),Ss(null,!0,!0),le&&(Ki=le)}function Wh(g,x,A,P,I,Y,se){pe._lock||(Kt(g),Le(),el(),g!=null&&Kr(iu,n,Dt,Bt,J,V,null))}function Xh(){w.forEach(c_),re(n.width,n.height,!0)}Fs(va,Sr,Xh);const Qs={};Qs.mousedown=Hh,Qs.mousemove=Oh,Qs.mouseup=Gh,Qs.dblclick=Wh,Qs.setSeries=(g,x,A,P)=>{let I=Wt.match[2];A=I(n,x,A),A!=-1&&Si(A,P,!0,!1)},ae&&(Pe(eu,_,Hh),Pe(al,_,Oh),Pe(tu,_,g=>{Kt(g),jr(!1)}),Pe(nu,_,um),Pe(iu,_,Wh),nc.add(n),n.syncRect=jr);const Io=n.hooks=i.hooks||{};function an(g,x,A){qa?Xr.push([g,x,A]):g in Io&&Io[g].forEach(P=>{P.call(null,n,x,A)})}(i.plugins||[]).forEach(g=>{for(let x in g.hooks)Io[x]=(Io[x]||[]).concat(g.hooks[x])});const Yh=(g,x,A)=>A,Wt=qt({key:null,setSeries:!1,filters:{pub:pu,sub:pu},scales:[D,b[1]?b[1].scale:null],match:[mu,mu,Yh],values:[null,null]},pe.sync);Wt.match.length==2&&Wt.match.push(Yh),pe.sync=Wt;const qh=Wt.key,tl=Gd(qh);function Kr(g,x,A,P,I,Y,se){Wt.filters.pub(g,x,A,P,I,Y,se)&&tl.pub(g,x,A,P,I,Y,se)}tl.sub(n);function fm(g,x,A,P,I,Y,se){Wt.filters.sub(g,x,A,P,I,Y,se)&&Qs[g](null,x,A,P,I,Y,se)}n.pub=fm;function dm(){tl.unsub(n),nc.delete(n),ct.clear(),$l(va,Sr,Xh),c.remove(),oe?.remove(),an("destroy")}n.destroy=dm;function nl(){an("init",i,e),Fe(e||i.data,!1),Z[D]?ja(D,Z[D]):Le(),xe=Lt.show&&(Lt.width>0||Lt.height>0),O=ne=!0,re(i.width,i.height)}return b.forEach(Wr),w.forEach(Xa),t?t instanceof HTMLElement?(t.appendChild(c),nl()):t(n,nl):nl(),n}_n.assign=qt;_n.fmtNum=oh;_n.rangeNum=xa;_n.rangeLog=La;_n.rangeAsinh=sh;_n.orient=Vs;_n.pxRatio=vt;_n.join=eg;_n.fmtDate=lh,_n.tzDate=ug;_n.sync=Gd;{_n.addGap=qg,_n.clipGaps=Na;let i=_n.paths={points:Kd};i.linear=$d,i.stepped=Zg,i.bars=$g,i.spline=Qg}const tp=4,h_=1e-6,u_=3,Ou=i=>typeof i=="number"?i*h_:void 0,f_=({link:i,address:e},t)=>String(i??e??t+1).replace(/^.*@/,""),d_=({usable:i,in_gap:e})=>i===!1?"unusable":e?"in_gap":null;class p_{constructor(){this.sender=-1/0,this.before=[]}of({elements:e={}},t){const n=Object.values(e).filter(({links:a})=>a?.length>1),s=n.find(({links:a})=>"sent_bitrate"in a[0]);s&&(this.sender=t);const r=s??(t-this.sender<u_?void 0:n[0]),o={};return r?.links.slice(0,tp).forEach((a,l)=>{const c=s?a.sent_bitrate:this.received(a,l,t);o[`link_${l}`]={name:f_(a,l),state:d_(a)},Object.assign(o,{[`link_${l}_bitrate`]:c,[`link_${l}_rtt`]:Ou(a.rtt),[`link_${l}_queue`]:Ou(a.queue_delay)})}),o}received({bytes_received:e},t,n){const s=this.before[t];if(this.before[t]={bytes:e,now:n},!(!s||n<=s.now||e<s.bytes))return(e-s.bytes)*8/(n-s.now)}}const m_={scene:["Point cloud. Arrow keys turn, plus and minus zoom, 0 goes home.","Punktwolke. Pfeiltasten drehen, Plus und Minus zoomen, 0 geht zurück."],scale:["Colour scale","Farbskala"],view:["View","Ansicht"],colour:["Colour by","Farbe nach"],robot:["Robot","Roboter"],follow:["Follow","Folgen"],follow_title:["The camera goes with the sensor (F)","Die Kamera geht mit dem Sensor (F)"],map:["Map","Karte"],map_title:["What odometry has seen so far (M)","Was die Odometrie bisher sah (M)"],trail:["Trail","Spur"],trail_title:["Points stay for a second (T)","Punkte bleiben eine Sekunde (T)"],measure:["Measure","Messen"],measure_title:["Distance between two points (R)","Abstand zweier Punkte (R)"],measure_first:["Choose a point","Einen Punkt wählen"],measure_second:["Choose the other point","Den anderen Punkt wählen"],top:["Top","Oben"],top_title:["Look from above (O)","Von oben sehen (O)"],pause:["Pause","Pause"],pause_title:["Hold the picture (Space)","Das Bild anhalten (Leertaste)"],snapshot:["Snapshot","Foto"],snapshot_title:["Save the picture as PNG (S)","Das Bild als PNG sichern (S)"],panel:["Charts","Kurven"],panel_title:["Charts (C)","Kurven (C)"],theme:["Theme","Hell/Dunkel"],theme_title:["Dark or light (D)","Dunkel oder hell (D)"],time:["Time","Zeit"],back:["−10 s","−10 s"],back_title:["Ten seconds back (B)","Zehn Sekunden zurück (B)"],forth:["+10 s","+10 s"],forth_title:["Ten seconds on (N)","Zehn Sekunden weiter (N)"],live_title:["Back to what is now (L)","Zurück zum Jetzt (L)"],past:["Recorded","Aufgezeichnet"],loading:["Loading the recording","Lädt die Aufzeichnung"],recording_broken:["The recording on the server cannot be read.","Die Aufzeichnung auf dem Server ist nicht lesbar."],recording_damaged:["Damaged parts of the recording are left out.","Beschädigte Teile der Aufzeichnung fehlen."],ago:["ago","her"],more:["More","Mehr"],more_title:["All controls","Alle Bedienelemente"],clip_low:["Show from [m]","Zeigen ab [m]"],clip_high:["Show up to [m]","Zeigen bis [m]"],statistics:["Statistics of the pipeline","Zahlen der Pipeline"],entry:["A token is needed","Ein Token ist nötig"],entry_text:["This server lets in who knows the token of its foxglovesink.","Dieser Server lässt ein, wer das Token seines foxglovesink kennt."],token:["Token","Token"],connect:["Connect","Verbinden"],camera:["Camera","Kamera"],height:["Height","Höhe"],intensity:["Intensity","Intensität"],range:["Range","Entfernung"],beam:["Beam","Strahl"],age:["Age","Alter"],connecting:["Connecting","Verbindet"],live:["Live","Live"],stalled:["No clouds","Keine Wolken"],stalled_text:["Connected, but no cloud has come for two seconds.","Verbunden, aber seit zwei Sekunden kam keine Wolke."],lost:["Connection lost","Verbindung verloren"],lost_text:["The server does not answer. Trying again.","Der Server antwortet nicht. Neuer Versuch."],refused:["Not admitted","Nicht eingelassen"],refused_text:["The token is missing or wrong.","Das Token fehlt oder ist falsch."],expired:["Token expired","Token abgelaufen"],expired_text:["The token has expired. Enter a new one.","Das Token ist abgelaufen. Ein neues eingeben."],foreign:["Not admitted","Nicht eingelassen"],foreign_text:["The server serves pages of another address.","Der Server bedient Seiten einer anderen Adresse."],limited:["Too many attempts","Zu viele Versuche"],limited_text:["The server lets nobody in for a while. Trying again.","Der Server lässt eine Weile niemanden ein. Neuer Versuch."],full:["Server is full","Server ist voll"],full_text:["Too many viewers are connected. Trying again.","Zu viele Betrachter sind verbunden. Neuer Versuch."],paused:["paused","angehalten"],old:["old","alt"],to_page:["to this page","zu dieser Seite"],Bitrate:["Bitrate","Bitrate"],Delay:["Delay","Verzögerung"],Window:["Window","Fenster"],Precision:["Precision","Genauigkeit"],Losses:["Losses","Verluste"],"Age of the cloud":["Age of the cloud","Alter der Wolke"],"To this page":["To this page","Zu dieser Seite"],Links:["Links","Verbindungen"],"Round trip of links":["Round trip of links","Hin und zurück je Verbindung"],"Queue of links":["Queue of links","Warteschlange je Verbindung"],unusable:["not usable","nicht nutzbar"],in_gap:["in a gap","in einer Lücke"],"since the start":["since the start","seit dem Start"],capacity:["capacity","Kapazität"],target:["target","Ziel"],sent:["sent","gesendet"],"round trip":["round trip","hin und zurück"],queue:["queue","Warteschlange"],"allowed in flight":["allowed in flight","unterwegs erlaubt"],"in flight":["in flight","unterwegs"],step:["step","Raster"],"largest error":["bound of the error","Fehlerschranke"],"packets lost":["packets lost","Pakete verloren"],marked:["marked","markiert"],"slices lost":["slices lost","Sektoren verloren"],"Deviation of the pose":["Deviation of the pose","Abweichung der Pose"],position:["position","Position"],Poses:["Poses","Posen"],"poses lost":["lost","verloren"],degenerate:["degenerate","unbestimmt"],received:["received","empfangen"],drawn:["when drawn","beim Zeichnen"],link:["link","Verbindung"]},g_=new URLSearchParams(globalThis.location?.search).get("lang")??globalThis.navigator?.language??"en",ka=g_.startsWith("de")?"de":"en",Ht=i=>m_[i]?.[ka==="de"?1:0]??i,di=(i,e=0)=>i.toLocaleString(ka,{minimumFractionDigits:e,maximumFractionDigits:e});function __(i){document.documentElement.lang=ka;for(const e of i.querySelectorAll("[data-text]"))e.textContent=Ht(e.dataset.text);for(const e of i.querySelectorAll("[data-title]"))e.title=Ht(e.dataset.title);for(const e of i.querySelectorAll("[data-label]"))e.setAttribute("aria-label",Ht(e.dataset.label))}const nr=60,Jr=1e-6,Bu=.001,v_=2.5,x_=Array.from({length:tp},(i,e)=>e),dl=(i,e,t,n=1)=>({title:i,unit:e,series:x_.map(s=>({key:`link_${s}_${t}`,link:`link_${s}`,label:"link",scale:n}))}),S_=[{title:"Age of the cloud",unit:"ms",series:[{key:"age",label:"drawn",scale:1e3}]},{title:"Bitrate",unit:"Mbit/s",series:[{key:"estimated_capacity",label:"capacity",scale:Jr,quiet:!0},{key:"target_bitrate",label:"target",scale:Jr},{key:"sent_bitrate",label:"sent",scale:Jr}]},{title:"Delay",unit:"ms",series:[{key:"rtt",label:"round trip",quiet:!0},{key:"queue_delay",label:"queue"}]},{title:"Window",unit:"kB",series:[{key:"ref_wnd",label:"allowed in flight",scale:Bu,quiet:!0},{key:"bytes_in_flight",label:"in flight",scale:Bu}]},{title:"Precision",unit:"mm",series:[{key:"step",label:"step",scale:1e3},{key:"error_bound",label:"largest error",scale:1e3,quiet:!0}]},{title:"Losses",unit:"since the start",whole:!0,series:[{key:"packets_lost",label:"packets lost"},{key:"packets_ce",label:"marked",quiet:!0},{key:"slices_lost",label:"slices lost"}]},{title:"Deviation of the pose",unit:"m",series:[{key:"position_deviation",label:"position"}]},{title:"Poses",unit:"since the start",whole:!0,series:[{key:"poses_lost",label:"poses lost"},{key:"poses_degenerate",label:"degenerate",quiet:!0}]},{title:"To this page",unit:"Mbit/s",series:[{key:"received",label:"received",scale:Jr}]},dl("Links","Mbit/s","bitrate",Jr),dl("Round trip of links","ms","rtt"),dl("Queue of links","ms","queue")],ku=(i,e)=>i==null?"–":e||i>=100?di(i):di(i,i>=10?1:2);class M_{constructor(e,t){this.config=e,this.data=[[],...e.series.map(()=>[])],this.element=document.createElement("section"),this.element.className="chart",this.element.hidden=!0,this.element.innerHTML=`<h2>${Ht(e.title)}<span>${Ht(e.unit)}</span></h2>
      <dl></dl><div class="plot" role="img"></div>`,this.list=this.element.querySelector("dl"),this.values=e.series.map((n,s)=>{const r=document.createElement("div");return r.innerHTML=`<dt><i data-line="${s}"${n.quiet?" data-quiet":""}></i><span></span></dt><dd>–</dd>`,r.querySelector("span").textContent=Ht(n.label),this.list.append(r),r}),this.plotElement=this.element.querySelector(".plot"),t.append(this.element)}add(e,t){const n=this.config.series.map(({key:s,scale:r=1})=>typeof t[s]=="number"?t[s]*r:null);if(!(this.element.hidden&&n.every(s=>s===null))){for(this.element.hidden=!1,this.data[0].push(e),n.forEach((s,r)=>this.data[r+1].push(s));this.data[0][0]<e-nr;)this.data.forEach(s=>s.shift());this.values.forEach((s,r)=>{s.hidden=this.data[r+1].every(a=>a===null),s.querySelector("dd").textContent=ku(n[r],this.config.whole);const o=t[this.config.series[r].link];o&&(s.querySelector("span").textContent=o.state?`${o.name} (${Ht(o.state)})`:o.name)}),this.plotElement.setAttribute("aria-label",`${Ht(this.config.title)}: `+this.config.series.map((s,r)=>`${Ht(s.label)} ${ku(n[r])}`).join(", "))}}draw(e,t){this.element.hidden||this.plotElement.clientWidth===0||((!this.plot||this.style!==e)&&this.make(e),this.plot.width!==this.plotElement.clientWidth&&this.plot.setSize({width:this.plotElement.clientWidth,height:this.plot.height}),this.now=t,this.plot.setData(this.data))}top(){const e=s=>this.config.series.reduce((r,o,a)=>!!o.quiet!==s?r:this.data[a+1].reduce((l,c)=>Math.max(l,c??0),r),0),t=e(!1),n=t>0?Math.max(t,Math.min(e(!0),v_*t)):e(!0);return n>0?n*1.15:1}make(e){this.plot?.destroy(),this.style=e;const t={stroke:e.muted,font:"11px system-ui, sans-serif",ticks:{show:!1},grid:{stroke:e.line,width:1}},n=this.config.series.map((s,r)=>({label:s.label,stroke:e.series[r],width:s.quiet?1.25:2,dash:s.quiet?[3,3]:void 0,points:{show:!1},spanGaps:!0}));this.plot=new _n({width:this.plotElement.clientWidth,height:108,legend:{show:!1},cursor:{show:!1},padding:[8,4,8,0],scales:{x:{time:!1,range:()=>[this.now-nr,this.now]},y:{range:()=>[0,this.top()]}},axes:[{...t,size:18,gap:2,splits:()=>[this.now-nr+4,this.now-nr/2,this.now-1],values:()=>[`−${nr} s`,`−${nr/2} s`,"0"]},{...t,size:42,space:26,gap:4,values:(s,r)=>r.map(o=>di(o,o%1?1:0))}],series:[{},...n]},this.data,this.plotElement)}}class y_{constructor(e){this.charts=S_.map(t=>new M_(t,e)),this.samples=0}add(e){const t=performance.now()/1e3;++this.samples;for(const n of this.charts)n.add(t,e)}draw(e){const t=performance.now()/1e3;for(const n of this.charts)n.draw(e,t)}}const E_=1,b_=600,fo=()=>(performance.timeOrigin+performance.now())*.001;class T_{constructor(){this.differences=[]}arrived(e){return this.differences.push(fo()-e),this.differences.length>b_&&this.differences.shift(),fo()}ageOf(e){const t=Math.min(...this.differences),n=t>=0&&t<E_?0:t;return fo()-n-e}}const Ma=24,w_=1,A_=1e3,C_=[0,97,115,109,1,0,0,0,1,5,1,96,0,1,123,3,2,1,0,10,10,1,8,0,65,0,253,15,253,98,11],R_=()=>typeof Worker=="function"&&WebAssembly.validate(new Uint8Array(C_)),P_=i=>Uint8Array.from(atob(i),e=>e.charCodeAt(0));function D_(i){if(i.length<Ma)return null;const e=new DataView(i.buffer,i.byteOffset,Ma);return e.getUint8(0)!==w_?null:{recoded:(e.getUint8(1)&1)!==0,isPose:(e.getUint8(1)&2)!==0,slice:e.getUint16(2,!0),slices:e.getUint16(4,!0),replay:e.getUint16(6,!0),scan:e.getUint32(8,!0),sent:Number(e.getBigUint64(16,!0))*1e-9}}class L_{constructor(e,t,n){Object.assign(this,{id:e,channel:t,about:n}),this.clock=new T_,this.newest=null,this.told=null,this.complained=0}}class U_{constructor(e,t){Object.assign(this,{on:e,connection:t}),this.streams=new Map,this.abouts=[],this.damaged=0}open(e){const t=JSON.parse(e.schema),n=new L_(this.abouts.push(t)-1,e,t);this.streams.set(e,n);const s=t.geometry==="range"?P_(t.sensorModel):new Uint8Array;return this.start().postMessage({open:n.id,model:s}),n}start(){return this.worker?this.worker:(this.worker=new Worker(new URL(""+new URL("slice_worker.js",import.meta.url).href,import.meta.url),{type:"module"}),this.worker.onmessage=({data:e})=>this.decoded(e),this.worker)}close(e){const t=this.streams.get(e);t&&(this.streams.delete(e),this.worker.postMessage({close:t.id}))}add(e,t,n){const s=D_(t);if(!s)return;const r=this.streams.get(e)??this.open(e);if(s.captured=Number(n)*1e-9,s.isPose)return this.on.pose(s,t.subarray(Ma)),this.on.arrived(e,s);s.replay===0&&r.clock.arrived(s.sent);const o=t.byteOffset+Ma;this.worker.postMessage({stream:r.id,header:s,data:t.buffer,offset:o},[t.buffer])}decoded({picture:e,span:t,stream:n,header:s,...r}){if(e)return this.on.picture(e);t&&this.on.span(t);const o=[...this.streams.values()].find(l=>l.id===n);if(!o)return;if(s.replay!==0)return this.on.arrived(o.channel,s);if(o.newest=s,r.points)return this.on.points(o.about,s,r,o.clock);++this.damaged;const a=performance.now();!r.lacksReference||a-o.complained<A_||(o.complained=a,this.connection().tell("lacksReference",o.channel))}show(e,t=!1){this.worker?.postMessage({show:e,isReplay:t})}replay(e){this.start().postMessage({replay:e})}forget(){this.worker?.postMessage({forget:!0})}drawn(){for(const e of this.streams.values()){const{newest:t}=e;t!==e.told&&(e.told=t,this.connection().tell("drawn",e.channel,{scan:t.scan,slice:t.slice}))}}}const I_=["foxglove.PointCloud","foxglove.CompressedPointCloud"],sc="lidar.Slice",zu="foxglove.CompressedVideo";function rc({schemaName:i,schema:e,topic:t}){if(I_.includes(i))return t;if(i!==sc)return null;try{return JSON.parse(e).clouds??t}catch{return t}}const oc=i=>i.split("/").filter(Boolean)[0];function np(i){const e=i.map(rc).filter(t=>t!==null);return e.every(t=>t.split("/").filter(Boolean).length>1)?[...new Set(e.map(oc))].sort():[]}function N_(i,{known:e,robot:t,idle:n,paused:s}){if(n)return[];const r=np(i),o=r.includes(t)?t:r[0],a=({topic:f})=>oc(f)!==o&&r.includes(oc(f)),l=R_(),c=i.filter(f=>f.schemaName===zu&&!a(f)).map(({topic:f})=>f),[u]=c.sort(),h=new Set(l?i.filter(f=>f.schemaName===sc).map(rc):[]);return i.filter(f=>{if(!(f.schemaName in e)||a(f))return!1;if(f.schemaName===zu)return f.topic===u;const m=rc(f);return m===null?!0:s?!1:f.schemaName===sc?l:!h.has(m)})}function ip(i){return i&&i.__esModule&&Object.prototype.hasOwnProperty.call(i,"default")?i.default:i}var sp={exports:{}};(function(i){var e=Object.prototype.hasOwnProperty,t="~";function n(){}Object.create&&(n.prototype=Object.create(null),new n().__proto__||(t=!1));function s(l,c,u){this.fn=l,this.context=c,this.once=u||!1}function r(l,c,u,h,f){if(typeof u!="function")throw new TypeError("The listener must be a function");var m=new s(u,h||l,f),_=t?t+c:c;return l._events[_]?l._events[_].fn?l._events[_]=[l._events[_],m]:l._events[_].push(m):(l._events[_]=m,l._eventsCount++),l}function o(l,c){--l._eventsCount===0?l._events=new n:delete l._events[c]}function a(){this._events=new n,this._eventsCount=0}a.prototype.eventNames=function(){var c=[],u,h;if(this._eventsCount===0)return c;for(h in u=this._events)e.call(u,h)&&c.push(t?h.slice(1):h);return Object.getOwnPropertySymbols?c.concat(Object.getOwnPropertySymbols(u)):c},a.prototype.listeners=function(c){var u=t?t+c:c,h=this._events[u];if(!h)return[];if(h.fn)return[h.fn];for(var f=0,m=h.length,_=new Array(m);f<m;f++)_[f]=h[f].fn;return _},a.prototype.listenerCount=function(c){var u=t?t+c:c,h=this._events[u];return h?h.fn?1:h.length:0},a.prototype.emit=function(c,u,h,f,m,_){var v=t?t+c:c;if(!this._events[v])return!1;var p=this._events[v],d=arguments.length,b,w;if(p.fn){switch(p.once&&this.removeListener(c,p.fn,void 0,!0),d){case 1:return p.fn.call(p.context),!0;case 2:return p.fn.call(p.context,u),!0;case 3:return p.fn.call(p.context,u,h),!0;case 4:return p.fn.call(p.context,u,h,f),!0;case 5:return p.fn.call(p.context,u,h,f,m),!0;case 6:return p.fn.call(p.context,u,h,f,m,_),!0}for(w=1,b=new Array(d-1);w<d;w++)b[w-1]=arguments[w];p.fn.apply(p.context,b)}else{var M=p.length,B;for(w=0;w<M;w++)switch(p[w].once&&this.removeListener(c,p[w].fn,void 0,!0),d){case 1:p[w].fn.call(p[w].context);break;case 2:p[w].fn.call(p[w].context,u);break;case 3:p[w].fn.call(p[w].context,u,h);break;case 4:p[w].fn.call(p[w].context,u,h,f);break;default:if(!b)for(B=1,b=new Array(d-1);B<d;B++)b[B-1]=arguments[B];p[w].fn.apply(p[w].context,b)}}return!0},a.prototype.on=function(c,u,h){return r(this,c,u,h,!1)},a.prototype.once=function(c,u,h){return r(this,c,u,h,!0)},a.prototype.removeListener=function(c,u,h,f){var m=t?t+c:c;if(!this._events[m])return this;if(!u)return o(this,m),this;var _=this._events[m];if(_.fn)_.fn===u&&(!f||_.once)&&(!h||_.context===h)&&o(this,m);else{for(var v=0,p=[],d=_.length;v<d;v++)(_[v].fn!==u||f&&!_[v].once||h&&_[v].context!==h)&&p.push(_[v]);p.length?this._events[m]=p.length===1?p[0]:p:o(this,m)}return this},a.prototype.removeAllListeners=function(c){var u;return c?(u=t?t+c:c,this._events[u]&&o(this,u)):(this._events=new n,this._eventsCount=0),this},a.prototype.off=a.prototype.removeListener,a.prototype.addListener=a.prototype.on,a.prefixed=t,a.EventEmitter=a,i.exports=a})(sp);var F_=sp.exports;const O_=ip(F_);var wi;(function(i){i[i.MESSAGE_DATA=1]="MESSAGE_DATA",i[i.TIME=2]="TIME",i[i.SERVICE_CALL_RESPONSE=3]="SERVICE_CALL_RESPONSE",i[i.FETCH_ASSET_RESPONSE=4]="FETCH_ASSET_RESPONSE"})(wi||(wi={}));var Rr;(function(i){i[i.MESSAGE_DATA=1]="MESSAGE_DATA",i[i.SERVICE_CALL_REQUEST=2]="SERVICE_CALL_REQUEST"})(Rr||(Rr={}));var Vu;(function(i){i[i.INFO=0]="INFO",i[i.WARNING=1]="WARNING",i[i.ERROR=2]="ERROR"})(Vu||(Vu={}));var Vn;(function(i){i.clientPublish="clientPublish",i.time="time",i.parameters="parameters",i.parametersSubscribe="parametersSubscribe",i.services="services",i.connectionGraph="connectionGraph",i.assets="assets"})(Vn||(Vn={}));var ya;(function(i){i[i.SUCCESS=0]="SUCCESS",i[i.ERROR=1]="ERROR"})(ya||(ya={}));const Hu=new TextDecoder;function B_(i){const e=i instanceof ArrayBuffer?new DataView(i):i instanceof DataView?i:new DataView(i.buffer,i.byteOffset,i.byteLength);let t=0;const n=e.getUint8(t);switch(t+=1,n){case wi.MESSAGE_DATA:{const s=e.getUint32(t,!0);t+=4;const r=e.getBigUint64(t,!0);t+=8;const o=new DataView(e.buffer,e.byteOffset+t,e.byteLength-t);return{op:n,subscriptionId:s,timestamp:r,data:o}}case wi.TIME:{const s=e.getBigUint64(t,!0);return{op:n,timestamp:s}}case wi.SERVICE_CALL_RESPONSE:{const s=e.getUint32(t,!0);t+=4;const r=e.getUint32(t,!0);t+=4;const o=e.getUint32(t,!0);t+=4;const a=new DataView(e.buffer,e.byteOffset+t,o),l=Hu.decode(a);t+=o;const c=new Uint8Array(e.buffer,e.byteOffset+t,e.byteLength-t);return{op:n,serviceId:s,callId:r,encoding:l,data:c}}case wi.FETCH_ASSET_RESPONSE:{const s=e.getUint32(t,!0);t+=4;const r=e.getUint8(t);t+=1;const o=e.getUint32(t,!0);t+=4;const a=Hu.decode(new DataView(e.buffer,e.byteOffset+t,o));switch(t+=o,r){case ya.SUCCESS:{const l=new DataView(e.buffer,e.byteOffset+t,e.byteLength-t);return{op:n,requestId:s,status:r,data:l}}case ya.ERROR:return{op:n,requestId:s,status:r,error:a};default:throw new Error(`Unrecognized fetch asset status: ${r}`)}}}throw new Error(`Unrecognized server opcode in binary message: ${n.toString(16)}`)}const k_=new TextEncoder;var kt,Hn,Ra,Pa,mn,op,Jn;class rp{constructor({ws:e}){er(this,mn);er(this,kt,new O_);er(this,Hn);er(this,Ra,0);er(this,Pa,0);sl(this,Hn,e),On(this,mn,op).call(this)}on(e,t){pt(this,kt).on(e,t)}off(e,t){pt(this,kt).off(e,t)}close(){pt(this,Hn).close()}subscribe(e){const t=rl(this,Ra)._++,n=[{id:t,channelId:e}];return On(this,mn,Jn).call(this,{op:"subscribe",subscriptions:n}),t}unsubscribe(e){On(this,mn,Jn).call(this,{op:"unsubscribe",subscriptionIds:[e]})}advertise(e){const t=++rl(this,Pa)._,n=[{id:t,...e}];return On(this,mn,Jn).call(this,{op:"advertise",channels:n}),t}unadvertise(e){On(this,mn,Jn).call(this,{op:"unadvertise",channelIds:[e]})}getParameters(e,t){On(this,mn,Jn).call(this,{op:"getParameters",parameterNames:e,id:t})}setParameters(e,t){On(this,mn,Jn).call(this,{op:"setParameters",parameters:e,id:t})}subscribeParameterUpdates(e){On(this,mn,Jn).call(this,{op:"subscribeParameterUpdates",parameterNames:e})}unsubscribeParameterUpdates(e){On(this,mn,Jn).call(this,{op:"unsubscribeParameterUpdates",parameterNames:e})}sendMessage(e,t){const n=new Uint8Array(5+t.byteLength),s=new DataView(n.buffer,n.byteOffset,n.byteLength);s.setUint8(0,Rr.MESSAGE_DATA),s.setUint32(1,e,!0),n.set(t,5),pt(this,Hn).send(n)}sendServiceCallRequest(e){const t=k_.encode(e.encoding),n=new Uint8Array(13+t.length+e.data.byteLength),s=new DataView(n.buffer,n.byteOffset,n.byteLength);let r=0;s.setUint8(r,Rr.SERVICE_CALL_REQUEST),r+=1,s.setUint32(r,e.serviceId,!0),r+=4,s.setUint32(r,e.callId,!0),r+=4,s.setUint32(r,e.encoding.length,!0),r+=4,n.set(t,r),r+=t.length;const o=new Uint8Array(e.data.buffer,e.data.byteOffset,e.data.byteLength);n.set(o,r),pt(this,Hn).send(n)}subscribeConnectionGraph(){On(this,mn,Jn).call(this,{op:"subscribeConnectionGraph"})}unsubscribeConnectionGraph(){On(this,mn,Jn).call(this,{op:"unsubscribeConnectionGraph"})}fetchAsset(e,t){On(this,mn,Jn).call(this,{op:"fetchAsset",uri:e,requestId:t})}sendCallServiceRequest(e){this.sendServiceCallRequest(e)}}kt=new WeakMap,Hn=new WeakMap,Ra=new WeakMap,Pa=new WeakMap,mn=new WeakSet,op=function(){pt(this,Hn).binaryType="arraybuffer",pt(this,Hn).onerror=e=>{pt(this,kt).emit("error",e.error??new Error("WebSocket error"))},pt(this,Hn).onopen=e=>{pt(this,kt).emit("open")},pt(this,Hn).onmessage=e=>{let t;try{e.data instanceof ArrayBuffer||ArrayBuffer.isView(e.data)?t=B_(e.data):t=JSON.parse(e.data)}catch(n){pt(this,kt).emit("error",n);return}switch(t.op){case"serverInfo":pt(this,kt).emit("serverInfo",t);return;case"status":pt(this,kt).emit("status",t);return;case"removeStatus":pt(this,kt).emit("removeStatus",t);return;case"advertise":pt(this,kt).emit("advertise",t.channels);return;case"unadvertise":pt(this,kt).emit("unadvertise",t.channelIds);return;case"parameterValues":pt(this,kt).emit("parameterValues",t);return;case"advertiseServices":pt(this,kt).emit("advertiseServices",t.services);return;case"unadvertiseServices":pt(this,kt).emit("unadvertiseServices",t.serviceIds);return;case"connectionGraphUpdate":pt(this,kt).emit("connectionGraphUpdate",t);return;case"serviceCallFailure":pt(this,kt).emit("serviceCallFailure",t);return;case wi.MESSAGE_DATA:pt(this,kt).emit("message",t);return;case wi.TIME:pt(this,kt).emit("time",t);return;case wi.SERVICE_CALL_RESPONSE:pt(this,kt).emit("serviceCallResponse",t);return;case wi.FETCH_ASSET_RESPONSE:pt(this,kt).emit("fetchAssetResponse",t);return}pt(this,kt).emit("error",new Error(`Unrecognized server opcode: ${t.op}`))},pt(this,Hn).onclose=e=>{pt(this,kt).emit("close",e)}},Jn=function(e){pt(this,Hn).send(JSON.stringify(e))},Zh(rp,"SUPPORTED_SUBPROTOCOL","foxglove.websocket.v1");var ac={exports:{}},pl,Gu;function z_(){if(Gu)return pl;Gu=1;var i=1e3,e=i*60,t=e*60,n=t*24,s=n*7,r=n*365.25;pl=function(u,h){h=h||{};var f=typeof u;if(f==="string"&&u.length>0)return o(u);if(f==="number"&&isFinite(u))return h.long?l(u):a(u);throw new Error("val is not a non-empty string or a valid number. val="+JSON.stringify(u))};function o(u){if(u=String(u),!(u.length>100)){var h=/^(-?(?:\d+)?\.?\d+) *(milliseconds?|msecs?|ms|seconds?|secs?|s|minutes?|mins?|m|hours?|hrs?|h|days?|d|weeks?|w|years?|yrs?|y)?$/i.exec(u);if(h){var f=parseFloat(h[1]),m=(h[2]||"ms").toLowerCase();switch(m){case"years":case"year":case"yrs":case"yr":case"y":return f*r;case"weeks":case"week":case"w":return f*s;case"days":case"day":case"d":return f*n;case"hours":case"hour":case"hrs":case"hr":case"h":return f*t;case"minutes":case"minute":case"mins":case"min":case"m":return f*e;case"seconds":case"second":case"secs":case"sec":case"s":return f*i;case"milliseconds":case"millisecond":case"msecs":case"msec":case"ms":return f;default:return}}}}function a(u){var h=Math.abs(u);return h>=n?Math.round(u/n)+"d":h>=t?Math.round(u/t)+"h":h>=e?Math.round(u/e)+"m":h>=i?Math.round(u/i)+"s":u+"ms"}function l(u){var h=Math.abs(u);return h>=n?c(u,h,n,"day"):h>=t?c(u,h,t,"hour"):h>=e?c(u,h,e,"minute"):h>=i?c(u,h,i,"second"):u+" ms"}function c(u,h,f,m){var _=h>=f*1.5;return Math.round(u/f)+" "+m+(_?"s":"")}return pl}function V_(i){t.debug=t,t.default=t,t.coerce=l,t.disable=o,t.enable=s,t.enabled=a,t.humanize=z_(),t.destroy=c,Object.keys(i).forEach(u=>{t[u]=i[u]}),t.names=[],t.skips=[],t.formatters={};function e(u){let h=0;for(let f=0;f<u.length;f++)h=(h<<5)-h+u.charCodeAt(f),h|=0;return t.colors[Math.abs(h)%t.colors.length]}t.selectColor=e;function t(u){let h,f=null,m,_;function v(...p){if(!v.enabled)return;const d=v,b=Number(new Date),w=b-(h||b);d.diff=w,d.prev=h,d.curr=b,h=b,p[0]=t.coerce(p[0]),typeof p[0]!="string"&&p.unshift("%O");let M=0;p[0]=p[0].replace(/%([a-zA-Z%])/g,(D,L)=>{if(D==="%%")return"%";M++;const U=t.formatters[L];if(typeof U=="function"){const T=p[M];D=U.call(d,T),p.splice(M,1),M--}return D}),t.formatArgs.call(d,p),(d.log||t.log).apply(d,p)}return v.namespace=u,v.useColors=t.useColors(),v.color=t.selectColor(u),v.extend=n,v.destroy=t.destroy,Object.defineProperty(v,"enabled",{enumerable:!0,configurable:!1,get:()=>f!==null?f:(m!==t.namespaces&&(m=t.namespaces,_=t.enabled(u)),_),set:p=>{f=p}}),typeof t.init=="function"&&t.init(v),v}function n(u,h){const f=t(this.namespace+(typeof h>"u"?":":h)+u);return f.log=this.log,f}function s(u){t.save(u),t.namespaces=u,t.names=[],t.skips=[];const h=(typeof u=="string"?u:"").trim().replace(/\s+/g,",").split(",").filter(Boolean);for(const f of h)f[0]==="-"?t.skips.push(f.slice(1)):t.names.push(f)}function r(u,h){let f=0,m=0,_=-1,v=0;for(;f<u.length;)if(m<h.length&&(h[m]===u[f]||h[m]==="*"))h[m]==="*"?(_=m,v=f,m++):(f++,m++);else if(_!==-1)m=_+1,v++,f=v;else return!1;for(;m<h.length&&h[m]==="*";)m++;return m===h.length}function o(){const u=[...t.names,...t.skips.map(h=>"-"+h)].join(",");return t.enable(""),u}function a(u){for(const h of t.skips)if(r(u,h))return!1;for(const h of t.names)if(r(u,h))return!0;return!1}function l(u){return u instanceof Error?u.stack||u.message:u}function c(){console.warn("Instance method `debug.destroy()` is deprecated and no longer does anything. It will be removed in the next major version of `debug`.")}return t.enable(t.load()),t}var H_=V_;(function(i,e){var t={};e.formatArgs=s,e.save=r,e.load=o,e.useColors=n,e.storage=a(),e.destroy=(()=>{let c=!1;return()=>{c||(c=!0,console.warn("Instance method `debug.destroy()` is deprecated and no longer does anything. It will be removed in the next major version of `debug`."))}})(),e.colors=["#0000CC","#0000FF","#0033CC","#0033FF","#0066CC","#0066FF","#0099CC","#0099FF","#00CC00","#00CC33","#00CC66","#00CC99","#00CCCC","#00CCFF","#3300CC","#3300FF","#3333CC","#3333FF","#3366CC","#3366FF","#3399CC","#3399FF","#33CC00","#33CC33","#33CC66","#33CC99","#33CCCC","#33CCFF","#6600CC","#6600FF","#6633CC","#6633FF","#66CC00","#66CC33","#9900CC","#9900FF","#9933CC","#9933FF","#99CC00","#99CC33","#CC0000","#CC0033","#CC0066","#CC0099","#CC00CC","#CC00FF","#CC3300","#CC3333","#CC3366","#CC3399","#CC33CC","#CC33FF","#CC6600","#CC6633","#CC9900","#CC9933","#CCCC00","#CCCC33","#FF0000","#FF0033","#FF0066","#FF0099","#FF00CC","#FF00FF","#FF3300","#FF3333","#FF3366","#FF3399","#FF33CC","#FF33FF","#FF6600","#FF6633","#FF9900","#FF9933","#FFCC00","#FFCC33"];function n(){if(typeof window<"u"&&window.process&&(window.process.type==="renderer"||window.process.__nwjs))return!0;if(typeof navigator<"u"&&navigator.userAgent&&navigator.userAgent.toLowerCase().match(/(edge|trident)\/(\d+)/))return!1;let c;return typeof document<"u"&&document.documentElement&&document.documentElement.style&&document.documentElement.style.WebkitAppearance||typeof window<"u"&&window.console&&(window.console.firebug||window.console.exception&&window.console.table)||typeof navigator<"u"&&navigator.userAgent&&(c=navigator.userAgent.toLowerCase().match(/firefox\/(\d+)/))&&parseInt(c[1],10)>=31||typeof navigator<"u"&&navigator.userAgent&&navigator.userAgent.toLowerCase().match(/applewebkit\/(\d+)/)}function s(c){if(c[0]=(this.useColors?"%c":"")+this.namespace+(this.useColors?" %c":" ")+c[0]+(this.useColors?"%c ":" ")+"+"+i.exports.humanize(this.diff),!this.useColors)return;const u="color: "+this.color;c.splice(1,0,u,"color: inherit");let h=0,f=0;c[0].replace(/%[a-zA-Z%]/g,m=>{m!=="%%"&&(h++,m==="%c"&&(f=h))}),c.splice(f,0,u)}e.log=console.debug||console.log||(()=>{});function r(c){try{c?e.storage.setItem("debug",c):e.storage.removeItem("debug")}catch{}}function o(){let c;try{c=e.storage.getItem("debug")||e.storage.getItem("DEBUG")}catch{}return!c&&typeof process<"u"&&"env"in process&&(c=t.DEBUG),c}function a(){try{return localStorage}catch{}}i.exports=H_(e);const{formatters:l}=i.exports;l.j=function(c){try{return JSON.stringify(c)}catch(u){return"[UnexpectedJSONParseError]: "+u.message}}})(ac,ac.exports);var G_=ac.exports;const W_=ip(G_);W_("foxglove:server");new TextEncoder;Vn.clientPublish,Vn.clientPublish,Rr.MESSAGE_DATA+"",Vn.clientPublish,Vn.parameters,Vn.parameters,Vn.parametersSubscribe,Vn.parametersSubscribe,Rr.SERVICE_CALL_REQUEST+"",Vn.services,Vn.connectionGraph,Vn.connectionGraph,Vn.assets;const Wu=500,X_=5e3,Y_=["foxglove.sdk.v1","foxglove.websocket.v1"],q_=4401,j_={401:"refused",403:"foreign",429:"limited",503:"full"},K_=["refused","expired"];function Z_(i,e){const t=new URL(".",location.href);return i!==location.host&&(t.host=i,t.pathname="/"),t.protocol=t.protocol==="https:"?"wss:":"ws:",t.hash="",t.search=e?`?token=${encodeURIComponent(e)}`:"",t}class ap{constructor(e,t,n,s){Object.assign(this,{host:e,token:t,on:n,wanted:s}),this.retry=Wu,this.open()}open(){this.on.state("connecting"),this.offered=new Map,this.subscriptions=new Map,this.socket=new WebSocket(Z_(this.host,this.token),Y_);const e=new rp({ws:this.socket});e.on("open",()=>{this.retry=Wu,this.on.state("open")}),e.on("error",()=>{}),e.on("advertise",t=>{for(const n of t)this.offered.set(n.id,n);this.choose()}),e.on("unadvertise",t=>{for(const n of t)this.offered.delete(n);this.choose()}),e.on("message",({subscriptionId:t,timestamp:n,data:s})=>{const r=this.subscriptions.get(t);r&&this.on.message(r,new Uint8Array(s.buffer,s.byteOffset,s.byteLength),n)}),e.on("close",t=>this.closed(t?.code)),this.socket.addEventListener("message",({data:t})=>this.read(t)),this.client=e}choose(){const e=[...this.offered.values()];this.on.channels?.(e);const t=new Set(this.wanted(e));for(const[n,s]of this.subscriptions)t.delete(s)||(this.subscriptions.delete(n),this.client.unsubscribe(n),this.on.dropped?.(s));for(const n of t)this.subscriptions.set(this.client.subscribe(n.id),n),this.on.subscribed?.(n)}read(e){if(typeof e!="string"||!e.includes('"recording"'))return;const{op:t,subscriptionId:n,...s}=JSON.parse(e),r=t==="recording"?this.subscriptions.get(n):void 0;r&&this.on.recording?.(r,s)}tell(e,t,n={}){if(this.socket.readyState===WebSocket.OPEN)for(const[s,r]of this.subscriptions)r===t&&this.socket.send(JSON.stringify({op:e,subscriptionId:s,...n}))}async closed(e){for(const n of this.subscriptions.values())this.on.dropped?.(n);this.subscriptions.clear(),this.on.state("lost");const t=e===q_?"expired":j_[await this.why()];t&&this.on.state(t),!K_.includes(t)&&(setTimeout(()=>this.open(),this.retry),this.retry=Math.min(this.retry*1.6,X_))}async why(){if(this.host!==location.host)return 0;try{const e=this.token?`?token=${encodeURIComponent(this.token)}`:"";return(await fetch(`session${e}`,{cache:"no-store"})).status}catch{return 0}}}const gi=6,Xu=[null,(i,e)=>i.getUint8(e),(i,e)=>i.getInt8(e),(i,e)=>i.getUint16(e,!0),(i,e)=>i.getInt16(e,!0),(i,e)=>i.getUint32(e,!0),(i,e)=>i.getInt32(e,!0),(i,e)=>i.getFloat32(e,!0),(i,e)=>i.getFloat64(e,!0)];function ml(i,e){for(const t of e){const n=i.find(s=>s.name===t);if(n&&Xu[n.type])return{offset:n.offset,read:Xu[n.type]}}return null}function $_(i){const{fields:e,stride:t,data:n}=i,s=t>0?Math.floor(n.length/t):0,r=["x","y","z"].map(m=>ml(e,[m])),o=new Float32Array(r.every(Boolean)?s*gi:0),a=ml(e,["intensity","reflectivity","signal"]),l=ml(e,["ring","beam","channel"]),c=new DataView(n.buffer,n.byteOffset,n.byteLength),[u,h,f]=r;for(let m=0,_=0,v=0;_<o.length;++m,_+=gi,v+=t)o[_]=u.read(c,v+u.offset),o[_+1]=h.read(c,v+h.offset),o[_+2]=f.read(c,v+f.offset),a&&(o[_+3]=a.read(c,v+a.offset)),l&&(o[_+4]=l.read(c,v+l.offset)),o[_+5]=Math.hypot(o[_],o[_+1],o[_+2]);return{points:o,has:{intensity:!!a,beam:!!l}}}function J_(i,e){const t=i.length/3,n=new Float32Array(t*gi);for(let s=0;s<t;++s){const r=s*gi;n.set(i.subarray(3*s,3*s+3),r),e&&(n[r+3]=e[s]),n[r+5]=Math.hypot(n[r],n[r+1],n[r+2])}return{points:n,has:{intensity:!!e,beam:!1}}}/**
 * @license
 * Copyright 2010-2024 Three.js Authors
 * SPDX-License-Identifier: MIT
 */const mh="170",Mr={ROTATE:0,DOLLY:1,PAN:2},vr={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Q_=0,Yu=1,e0=2,lp=1,t0=2,Bi=3,ps=0,Ln=1,ki=2,hs=0,yr=1,qu=2,ju=3,Ku=4,n0=5,Ls=100,i0=101,s0=102,r0=103,o0=104,a0=200,l0=201,c0=202,h0=203,lc=204,cc=205,u0=206,f0=207,d0=208,p0=209,m0=210,g0=211,_0=212,v0=213,x0=214,hc=0,uc=1,fc=2,Pr=3,dc=4,pc=5,mc=6,gc=7,cp=0,S0=1,M0=2,us=0,y0=1,E0=2,b0=3,T0=4,w0=5,A0=6,C0=7,hp=300,Dr=301,Lr=302,_c=303,vc=304,za=306,xc=1e3,Is=1001,Sc=1002,Xn=1003,R0=1004,Bo=1005,pi=1006,gl=1007,Ns=1008,Yi=1009,up=1010,fp=1011,vo=1012,gh=1013,Bs=1014,zi=1015,Eo=1016,_h=1017,vh=1018,Ur=1020,dp=35902,pp=1021,mp=1022,mi=1023,gp=1024,_p=1025,Er=1026,Ir=1027,vp=1028,xh=1029,xp=1030,Sh=1031,Mh=1033,fa=33776,da=33777,pa=33778,ma=33779,Mc=35840,yc=35841,Ec=35842,bc=35843,Tc=36196,wc=37492,Ac=37496,Cc=37808,Rc=37809,Pc=37810,Dc=37811,Lc=37812,Uc=37813,Ic=37814,Nc=37815,Fc=37816,Oc=37817,Bc=37818,kc=37819,zc=37820,Vc=37821,ga=36492,Hc=36494,Gc=36495,Sp=36283,Wc=36284,Xc=36285,Yc=36286,P0=3200,D0=3201,L0=0,U0=1,ls="",Gn="srgb",zr="srgb-linear",Va="linear",Tt="srgb",ir=7680,Zu=519,I0=512,N0=513,F0=514,Mp=515,O0=516,B0=517,k0=518,z0=519,qc=35044,jc=35048,$u="300 es",Vi=2e3,Ea=2001;class Hs{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});const n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){if(this._listeners===void 0)return!1;const n=this._listeners;return n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){if(this._listeners===void 0)return;const s=this._listeners[e];if(s!==void 0){const r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){if(this._listeners===void 0)return;const n=this._listeners[e.type];if(n!==void 0){e.target=this;const s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}}const dn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"];let Ju=1234567;const po=Math.PI/180,xo=180/Math.PI;function Wi(){const i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(dn[i&255]+dn[i>>8&255]+dn[i>>16&255]+dn[i>>24&255]+"-"+dn[e&255]+dn[e>>8&255]+"-"+dn[e>>16&15|64]+dn[e>>24&255]+"-"+dn[t&63|128]+dn[t>>8&255]+"-"+dn[t>>16&255]+dn[t>>24&255]+dn[n&255]+dn[n>>8&255]+dn[n>>16&255]+dn[n>>24&255]).toLowerCase()}function gn(i,e,t){return Math.max(e,Math.min(t,i))}function yh(i,e){return(i%e+e)%e}function V0(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function H0(i,e,t){return i!==e?(t-i)/(e-i):0}function mo(i,e,t){return(1-t)*i+t*e}function G0(i,e,t,n){return mo(i,e,1-Math.exp(-t*n))}function W0(i,e=1){return e-Math.abs(yh(i,e*2)-e)}function X0(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function Y0(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function q0(i,e){return i+Math.floor(Math.random()*(e-i+1))}function j0(i,e){return i+Math.random()*(e-i)}function K0(i){return i*(.5-Math.random())}function Z0(i){i!==void 0&&(Ju=i);let e=Ju+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function $0(i){return i*po}function J0(i){return i*xo}function Q0(i){return(i&i-1)===0&&i!==0}function ev(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function tv(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function nv(i,e,t,n,s){const r=Math.cos,o=Math.sin,a=r(t/2),l=o(t/2),c=r((e+n)/2),u=o((e+n)/2),h=r((e-n)/2),f=o((e-n)/2),m=r((n-e)/2),_=o((n-e)/2);switch(s){case"XYX":i.set(a*u,l*h,l*f,a*c);break;case"YZY":i.set(l*f,a*u,l*h,a*c);break;case"ZXZ":i.set(l*h,l*f,a*u,a*c);break;case"XZX":i.set(a*u,l*_,l*m,a*c);break;case"YXY":i.set(l*m,a*u,l*_,a*c);break;case"ZYZ":i.set(l*_,l*m,a*u,a*c);break;default:console.warn("THREE.MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function ui(i,e){switch(e.constructor){case Float32Array:return i;case Uint32Array:return i/4294967295;case Uint16Array:return i/65535;case Uint8Array:return i/255;case Int32Array:return Math.max(i/2147483647,-1);case Int16Array:return Math.max(i/32767,-1);case Int8Array:return Math.max(i/127,-1);default:throw new Error("Invalid component type.")}}function Et(i,e){switch(e.constructor){case Float32Array:return i;case Uint32Array:return Math.round(i*4294967295);case Uint16Array:return Math.round(i*65535);case Uint8Array:return Math.round(i*255);case Int32Array:return Math.round(i*2147483647);case Int16Array:return Math.round(i*32767);case Int8Array:return Math.round(i*127);default:throw new Error("Invalid component type.")}}const Kc={DEG2RAD:po,RAD2DEG:xo,generateUUID:Wi,clamp:gn,euclideanModulo:yh,mapLinear:V0,inverseLerp:H0,lerp:mo,damp:G0,pingpong:W0,smoothstep:X0,smootherstep:Y0,randInt:q0,randFloat:j0,randFloatSpread:K0,seededRandom:Z0,degToRad:$0,radToDeg:J0,isPowerOfTwo:Q0,ceilPowerOfTwo:ev,floorPowerOfTwo:tv,setQuaternionFromProperEuler:nv,normalize:Et,denormalize:ui};class nt{constructor(e=0,t=0){nt.prototype.isVector2=!0,this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){const t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=Math.max(e.x,Math.min(t.x,this.x)),this.y=Math.max(e.y,Math.min(t.y,this.y)),this}clampScalar(e,t){return this.x=Math.max(e,Math.min(t,this.x)),this.y=Math.max(e,Math.min(t,this.y)),this}clampLength(e,t){const n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(e,Math.min(t,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){const t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;const n=this.dot(e)/t;return Math.acos(gn(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){const t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){const n=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*n-o*s+e.x,this.y=r*s+o*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}}class Je{constructor(e,t,n,s,r,o,a,l,c){Je.prototype.isMatrix3=!0,this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c)}set(e,t,n,s,r,o,a,l,c){const u=this.elements;return u[0]=e,u[1]=s,u[2]=a,u[3]=t,u[4]=r,u[5]=l,u[6]=n,u[7]=o,u[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){const t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){const t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){const n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[3],l=n[6],c=n[1],u=n[4],h=n[7],f=n[2],m=n[5],_=n[8],v=s[0],p=s[3],d=s[6],b=s[1],w=s[4],M=s[7],B=s[2],D=s[5],L=s[8];return r[0]=o*v+a*b+l*B,r[3]=o*p+a*w+l*D,r[6]=o*d+a*M+l*L,r[1]=c*v+u*b+h*B,r[4]=c*p+u*w+h*D,r[7]=c*d+u*M+h*L,r[2]=f*v+m*b+_*B,r[5]=f*p+m*w+_*D,r[8]=f*d+m*M+_*L,this}multiplyScalar(e){const t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){const e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8];return t*o*u-t*a*c-n*r*u+n*a*l+s*r*c-s*o*l}invert(){const e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8],h=u*o-a*c,f=a*l-u*r,m=c*r-o*l,_=t*h+n*f+s*m;if(_===0)return this.set(0,0,0,0,0,0,0,0,0);const v=1/_;return e[0]=h*v,e[1]=(s*c-u*n)*v,e[2]=(a*n-s*o)*v,e[3]=f*v,e[4]=(u*t-s*l)*v,e[5]=(s*r-a*t)*v,e[6]=m*v,e[7]=(n*l-c*t)*v,e[8]=(o*t-n*r)*v,this}transpose(){let e;const t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){const t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,r,o,a){const l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*o+c*a)+o+e,-s*c,s*l,-s*(-c*o+l*a)+a+t,0,0,1),this}scale(e,t){return this.premultiply(_l.makeScale(e,t)),this}rotate(e){return this.premultiply(_l.makeRotation(-e)),this}translate(e,t){return this.premultiply(_l.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){const t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){const t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){const n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}}const _l=new Je;function yp(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function ba(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function iv(){const i=ba("canvas");return i.style.display="block",i}const Qu={};function lo(i){i in Qu||(Qu[i]=!0,console.warn(i))}function sv(i,e,t){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:n()}}setTimeout(r,t)})}function rv(i){const e=i.elements;e[2]=.5*e[2]+.5*e[3],e[6]=.5*e[6]+.5*e[7],e[10]=.5*e[10]+.5*e[11],e[14]=.5*e[14]+.5*e[15]}function ov(i){const e=i.elements;e[11]===-1?(e[10]=-e[10]-1,e[14]=-e[14]):(e[10]=-e[10],e[14]=-e[14]+1)}const ft={enabled:!0,workingColorSpace:zr,spaces:{},convert:function(i,e,t){return this.enabled===!1||e===t||!e||!t||(this.spaces[e].transfer===Tt&&(i.r=Xi(i.r),i.g=Xi(i.g),i.b=Xi(i.b)),this.spaces[e].primaries!==this.spaces[t].primaries&&(i.applyMatrix3(this.spaces[e].toXYZ),i.applyMatrix3(this.spaces[t].fromXYZ)),this.spaces[t].transfer===Tt&&(i.r=br(i.r),i.g=br(i.g),i.b=br(i.b))),i},fromWorkingColorSpace:function(i,e){return this.convert(i,this.workingColorSpace,e)},toWorkingColorSpace:function(i,e){return this.convert(i,e,this.workingColorSpace)},getPrimaries:function(i){return this.spaces[i].primaries},getTransfer:function(i){return i===ls?Va:this.spaces[i].transfer},getLuminanceCoefficients:function(i,e=this.workingColorSpace){return i.fromArray(this.spaces[e].luminanceCoefficients)},define:function(i){Object.assign(this.spaces,i)},_getMatrix:function(i,e,t){return i.copy(this.spaces[e].toXYZ).multiply(this.spaces[t].fromXYZ)},_getDrawingBufferColorSpace:function(i){return this.spaces[i].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(i=this.workingColorSpace){return this.spaces[i].workingColorSpaceConfig.unpackColorSpace}};function Xi(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function br(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}const ef=[.64,.33,.3,.6,.15,.06],tf=[.2126,.7152,.0722],nf=[.3127,.329],sf=new Je().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),rf=new Je().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);ft.define({[zr]:{primaries:ef,whitePoint:nf,transfer:Va,toXYZ:sf,fromXYZ:rf,luminanceCoefficients:tf,workingColorSpaceConfig:{unpackColorSpace:Gn},outputColorSpaceConfig:{drawingBufferColorSpace:Gn}},[Gn]:{primaries:ef,whitePoint:nf,transfer:Tt,toXYZ:sf,fromXYZ:rf,luminanceCoefficients:tf,outputColorSpaceConfig:{drawingBufferColorSpace:Gn}}});let sr;class av{static getDataURL(e){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let t;if(e instanceof HTMLCanvasElement)t=e;else{sr===void 0&&(sr=ba("canvas")),sr.width=e.width,sr.height=e.height;const n=sr.getContext("2d");e instanceof ImageData?n.putImageData(e,0,0):n.drawImage(e,0,0,e.width,e.height),t=sr}return t.width>2048||t.height>2048?(console.warn("THREE.ImageUtils.getDataURL: Image converted to jpg for performance reasons",e),t.toDataURL("image/jpeg",.6)):t.toDataURL("image/png")}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){const t=ba("canvas");t.width=e.width,t.height=e.height;const n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);const s=n.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Xi(r[o]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){const t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(Xi(t[n]/255)*255):t[n]=Xi(t[n]);return{data:t,width:e.width,height:e.height}}else return console.warn("THREE.ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}}let lv=0;class Ep{constructor(e=null){this.isSource=!0,Object.defineProperty(this,"id",{value:lv++}),this.uuid=Wi(),this.data=e,this.dataReady=!0,this.version=0}set needsUpdate(e){e===!0&&this.version++}toJSON(e){const t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];const n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(vl(s[o].image)):r.push(vl(s[o]))}else r=vl(s);n.url=r}return t||(e.images[this.uuid]=n),n}}function vl(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?av.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(console.warn("THREE.Texture: Unable to serialize Texture."),{})}let cv=0;class wn extends Hs{constructor(e=wn.DEFAULT_IMAGE,t=wn.DEFAULT_MAPPING,n=Is,s=Is,r=pi,o=Ns,a=mi,l=Yi,c=wn.DEFAULT_ANISOTROPY,u=ls){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:cv++}),this.uuid=Wi(),this.name="",this.source=new Ep(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new nt(0,0),this.repeat=new nt(1,1),this.center=new nt(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new Je,this.generateMipmaps=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.version=0,this.onUpdate=null,this.isRenderTargetTexture=!1,this.pmremVersion=0}get image(){return this.source.data}set image(e=null){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}toJSON(e){const t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];const n={metadata:{version:4.6,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==hp)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case xc:e.x=e.x-Math.floor(e.x);break;case Is:e.x=e.x<0?0:1;break;case Sc:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case xc:e.y=e.y-Math.floor(e.y);break;case Is:e.y=e.y<0?0:1;break;case Sc:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}}wn.DEFAULT_IMAGE=null;wn.DEFAULT_MAPPING=hp;wn.DEFAULT_ANISOTROPY=1;class Gt{constructor(e=0,t=0,n=0,s=1){Gt.prototype.isVector4=!0,this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){const t=this.x,n=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*n+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);const t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,r;const l=e.elements,c=l[0],u=l[4],h=l[8],f=l[1],m=l[5],_=l[9],v=l[2],p=l[6],d=l[10];if(Math.abs(u-f)<.01&&Math.abs(h-v)<.01&&Math.abs(_-p)<.01){if(Math.abs(u+f)<.1&&Math.abs(h+v)<.1&&Math.abs(_+p)<.1&&Math.abs(c+m+d-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;const w=(c+1)/2,M=(m+1)/2,B=(d+1)/2,D=(u+f)/4,L=(h+v)/4,U=(_+p)/4;return w>M&&w>B?w<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(w),s=D/n,r=L/n):M>B?M<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(M),n=D/s,r=U/s):B<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(B),n=L/r,s=U/r),this.set(n,s,r,t),this}let b=Math.sqrt((p-_)*(p-_)+(h-v)*(h-v)+(f-u)*(f-u));return Math.abs(b)<.001&&(b=1),this.x=(p-_)/b,this.y=(h-v)/b,this.z=(f-u)/b,this.w=Math.acos((c+m+d-1)/2),this}setFromMatrixPosition(e){const t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=Math.max(e.x,Math.min(t.x,this.x)),this.y=Math.max(e.y,Math.min(t.y,this.y)),this.z=Math.max(e.z,Math.min(t.z,this.z)),this.w=Math.max(e.w,Math.min(t.w,this.w)),this}clampScalar(e,t){return this.x=Math.max(e,Math.min(t,this.x)),this.y=Math.max(e,Math.min(t,this.y)),this.z=Math.max(e,Math.min(t,this.z)),this.w=Math.max(e,Math.min(t,this.w)),this}clampLength(e,t){const n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(e,Math.min(t,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}}class hv extends Hs{constructor(e=1,t=1,n={}){super(),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=1,this.scissor=new Gt(0,0,e,t),this.scissorTest=!1,this.viewport=new Gt(0,0,e,t);const s={width:e,height:t,depth:1};n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:pi,depthBuffer:!0,stencilBuffer:!1,resolveDepthBuffer:!0,resolveStencilBuffer:!0,depthTexture:null,samples:0,count:1},n);const r=new wn(s,n.mapping,n.wrapS,n.wrapT,n.magFilter,n.minFilter,n.format,n.type,n.anisotropy,n.colorSpace);r.flipY=!1,r.generateMipmaps=n.generateMipmaps,r.internalFormat=n.internalFormat,this.textures=[];const o=n.count;for(let a=0;a<o;a++)this.textures[a]=r.clone(),this.textures[a].isRenderTargetTexture=!0;this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.depthTexture=n.depthTexture,this.samples=n.samples}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n;this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let n=0,s=e.textures.length;n<s;n++)this.textures[n]=e.textures[n].clone(),this.textures[n].isRenderTargetTexture=!0;const t=Object.assign({},e.texture.image);return this.texture.source=new Ep(t),this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,e.depthTexture!==null&&(this.depthTexture=e.depthTexture.clone()),this.samples=e.samples,this}dispose(){this.dispatchEvent({type:"dispose"})}}class ks extends hv{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}}class bp extends wn{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Xn,this.minFilter=Xn,this.wrapR=Is,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}}class uv extends wn{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Xn,this.minFilter=Xn,this.wrapR=Is,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}}class ms{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=s}static slerpFlat(e,t,n,s,r,o,a){let l=n[s+0],c=n[s+1],u=n[s+2],h=n[s+3];const f=r[o+0],m=r[o+1],_=r[o+2],v=r[o+3];if(a===0){e[t+0]=l,e[t+1]=c,e[t+2]=u,e[t+3]=h;return}if(a===1){e[t+0]=f,e[t+1]=m,e[t+2]=_,e[t+3]=v;return}if(h!==v||l!==f||c!==m||u!==_){let p=1-a;const d=l*f+c*m+u*_+h*v,b=d>=0?1:-1,w=1-d*d;if(w>Number.EPSILON){const B=Math.sqrt(w),D=Math.atan2(B,d*b);p=Math.sin(p*D)/B,a=Math.sin(a*D)/B}const M=a*b;if(l=l*p+f*M,c=c*p+m*M,u=u*p+_*M,h=h*p+v*M,p===1-a){const B=1/Math.sqrt(l*l+c*c+u*u+h*h);l*=B,c*=B,u*=B,h*=B}}e[t]=l,e[t+1]=c,e[t+2]=u,e[t+3]=h}static multiplyQuaternionsFlat(e,t,n,s,r,o){const a=n[s],l=n[s+1],c=n[s+2],u=n[s+3],h=r[o],f=r[o+1],m=r[o+2],_=r[o+3];return e[t]=a*_+u*h+l*m-c*f,e[t+1]=l*_+u*f+c*h-a*m,e[t+2]=c*_+u*m+a*f-l*h,e[t+3]=u*_-a*h-l*f-c*m,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,s){return this._x=e,this._y=t,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){const n=e._x,s=e._y,r=e._z,o=e._order,a=Math.cos,l=Math.sin,c=a(n/2),u=a(s/2),h=a(r/2),f=l(n/2),m=l(s/2),_=l(r/2);switch(o){case"XYZ":this._x=f*u*h+c*m*_,this._y=c*m*h-f*u*_,this._z=c*u*_+f*m*h,this._w=c*u*h-f*m*_;break;case"YXZ":this._x=f*u*h+c*m*_,this._y=c*m*h-f*u*_,this._z=c*u*_-f*m*h,this._w=c*u*h+f*m*_;break;case"ZXY":this._x=f*u*h-c*m*_,this._y=c*m*h+f*u*_,this._z=c*u*_+f*m*h,this._w=c*u*h-f*m*_;break;case"ZYX":this._x=f*u*h-c*m*_,this._y=c*m*h+f*u*_,this._z=c*u*_-f*m*h,this._w=c*u*h+f*m*_;break;case"YZX":this._x=f*u*h+c*m*_,this._y=c*m*h+f*u*_,this._z=c*u*_-f*m*h,this._w=c*u*h-f*m*_;break;case"XZY":this._x=f*u*h-c*m*_,this._y=c*m*h-f*u*_,this._z=c*u*_+f*m*h,this._w=c*u*h+f*m*_;break;default:console.warn("THREE.Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){const n=t/2,s=Math.sin(n);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){const t=e.elements,n=t[0],s=t[4],r=t[8],o=t[1],a=t[5],l=t[9],c=t[2],u=t[6],h=t[10],f=n+a+h;if(f>0){const m=.5/Math.sqrt(f+1);this._w=.25/m,this._x=(u-l)*m,this._y=(r-c)*m,this._z=(o-s)*m}else if(n>a&&n>h){const m=2*Math.sqrt(1+n-a-h);this._w=(u-l)/m,this._x=.25*m,this._y=(s+o)/m,this._z=(r+c)/m}else if(a>h){const m=2*Math.sqrt(1+a-n-h);this._w=(r-c)/m,this._x=(s+o)/m,this._y=.25*m,this._z=(l+u)/m}else{const m=2*Math.sqrt(1+h-n-a);this._w=(o-s)/m,this._x=(r+c)/m,this._y=(l+u)/m,this._z=.25*m}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<Number.EPSILON?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(gn(this.dot(e),-1,1)))}rotateTowards(e,t){const n=this.angleTo(e);if(n===0)return this;const s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){const n=e._x,s=e._y,r=e._z,o=e._w,a=t._x,l=t._y,c=t._z,u=t._w;return this._x=n*u+o*a+s*c-r*l,this._y=s*u+o*l+r*a-n*c,this._z=r*u+o*c+n*l-s*a,this._w=o*u-n*a-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){if(t===0)return this;if(t===1)return this.copy(e);const n=this._x,s=this._y,r=this._z,o=this._w;let a=o*e._w+n*e._x+s*e._y+r*e._z;if(a<0?(this._w=-e._w,this._x=-e._x,this._y=-e._y,this._z=-e._z,a=-a):this.copy(e),a>=1)return this._w=o,this._x=n,this._y=s,this._z=r,this;const l=1-a*a;if(l<=Number.EPSILON){const m=1-t;return this._w=m*o+t*this._w,this._x=m*n+t*this._x,this._y=m*s+t*this._y,this._z=m*r+t*this._z,this.normalize(),this}const c=Math.sqrt(l),u=Math.atan2(c,a),h=Math.sin((1-t)*u)/c,f=Math.sin(t*u)/c;return this._w=o*h+this._w*f,this._x=n*h+this._x*f,this._y=s*h+this._y*f,this._z=r*h+this._z*f,this._onChangeCallback(),this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){const e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}}class H{constructor(e=0,t=0,n=0){H.prototype.isVector3=!0,this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(of.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(of.setFromAxisAngle(e,t))}applyMatrix3(e){const t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6]*s,this.y=r[1]*t+r[4]*n+r[7]*s,this.z=r[2]*t+r[5]*n+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){const t=this.x,n=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(e){const t=this.x,n=this.y,s=this.z,r=e.x,o=e.y,a=e.z,l=e.w,c=2*(o*s-a*n),u=2*(a*t-r*s),h=2*(r*n-o*t);return this.x=t+l*c+o*h-a*u,this.y=n+l*u+a*c-r*h,this.z=s+l*h+r*u-o*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){const t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*n+r[8]*s,this.y=r[1]*t+r[5]*n+r[9]*s,this.z=r[2]*t+r[6]*n+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=Math.max(e.x,Math.min(t.x,this.x)),this.y=Math.max(e.y,Math.min(t.y,this.y)),this.z=Math.max(e.z,Math.min(t.z,this.z)),this}clampScalar(e,t){return this.x=Math.max(e,Math.min(t,this.x)),this.y=Math.max(e,Math.min(t,this.y)),this.z=Math.max(e,Math.min(t,this.z)),this}clampLength(e,t){const n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(e,Math.min(t,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){const n=e.x,s=e.y,r=e.z,o=t.x,a=t.y,l=t.z;return this.x=s*l-r*a,this.y=r*o-n*l,this.z=n*a-s*o,this}projectOnVector(e){const t=e.lengthSq();if(t===0)return this.set(0,0,0);const n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return xl.copy(this).projectOnVector(e),this.sub(xl)}reflect(e){return this.sub(xl.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){const t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;const n=this.dot(e)/t;return Math.acos(gn(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){const t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){const s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){const t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){const t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){const e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}}const xl=new H,of=new ms;class bo{constructor(e=new H(1/0,1/0,1/0),t=new H(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(si.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(si.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){const n=si.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);const n=e.geometry;if(n!==void 0){const r=n.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,si):si.fromBufferAttribute(r,o),si.applyMatrix4(e.matrixWorld),this.expandByPoint(si);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),ko.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),ko.copy(n.boundingBox)),ko.applyMatrix4(e.matrixWorld),this.union(ko)}const s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,si),si.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Qr),zo.subVectors(this.max,Qr),rr.subVectors(e.a,Qr),or.subVectors(e.b,Qr),ar.subVectors(e.c,Qr),Qi.subVectors(or,rr),es.subVectors(ar,or),ys.subVectors(rr,ar);let t=[0,-Qi.z,Qi.y,0,-es.z,es.y,0,-ys.z,ys.y,Qi.z,0,-Qi.x,es.z,0,-es.x,ys.z,0,-ys.x,-Qi.y,Qi.x,0,-es.y,es.x,0,-ys.y,ys.x,0];return!Sl(t,rr,or,ar,zo)||(t=[1,0,0,0,1,0,0,0,1],!Sl(t,rr,or,ar,zo))?!1:(Vo.crossVectors(Qi,es),t=[Vo.x,Vo.y,Vo.z],Sl(t,rr,or,ar,zo))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,si).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(si).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(Ui[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Ui[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Ui[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Ui[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Ui[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Ui[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Ui[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Ui[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Ui),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}}const Ui=[new H,new H,new H,new H,new H,new H,new H,new H],si=new H,ko=new bo,rr=new H,or=new H,ar=new H,Qi=new H,es=new H,ys=new H,Qr=new H,zo=new H,Vo=new H,Es=new H;function Sl(i,e,t,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){Es.fromArray(i,r);const a=s.x*Math.abs(Es.x)+s.y*Math.abs(Es.y)+s.z*Math.abs(Es.z),l=e.dot(Es),c=t.dot(Es),u=n.dot(Es);if(Math.max(-Math.max(l,c,u),Math.min(l,c,u))>a)return!1}return!0}const fv=new bo,eo=new H,Ml=new H;class To{constructor(e=new H,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){const n=this.center;t!==void 0?n.copy(t):fv.setFromPoints(e).getCenter(n);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,n.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){const t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){const n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;eo.subVectors(e,this.center);const t=eo.lengthSq();if(t>this.radius*this.radius){const n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(eo,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Ml.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(eo.copy(e.center).add(Ml)),this.expandByPoint(eo.copy(e.center).sub(Ml))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}}const Ii=new H,yl=new H,Ho=new H,ts=new H,El=new H,Go=new H,bl=new H;class Ha{constructor(e=new H,t=new H(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Ii)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);const n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){const t=Ii.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Ii.copy(this.origin).addScaledVector(this.direction,t),Ii.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){yl.copy(e).add(t).multiplyScalar(.5),Ho.copy(t).sub(e).normalize(),ts.copy(this.origin).sub(yl);const r=e.distanceTo(t)*.5,o=-this.direction.dot(Ho),a=ts.dot(this.direction),l=-ts.dot(Ho),c=ts.lengthSq(),u=Math.abs(1-o*o);let h,f,m,_;if(u>0)if(h=o*l-a,f=o*a-l,_=r*u,h>=0)if(f>=-_)if(f<=_){const v=1/u;h*=v,f*=v,m=h*(h+o*f+2*a)+f*(o*h+f+2*l)+c}else f=r,h=Math.max(0,-(o*f+a)),m=-h*h+f*(f+2*l)+c;else f=-r,h=Math.max(0,-(o*f+a)),m=-h*h+f*(f+2*l)+c;else f<=-_?(h=Math.max(0,-(-o*r+a)),f=h>0?-r:Math.min(Math.max(-r,-l),r),m=-h*h+f*(f+2*l)+c):f<=_?(h=0,f=Math.min(Math.max(-r,-l),r),m=f*(f+2*l)+c):(h=Math.max(0,-(o*r+a)),f=h>0?r:Math.min(Math.max(-r,-l),r),m=-h*h+f*(f+2*l)+c);else f=o>0?-r:r,h=Math.max(0,-(o*f+a)),m=-h*h+f*(f+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,h),s&&s.copy(yl).addScaledVector(Ho,f),m}intersectSphere(e,t){Ii.subVectors(e.center,this.origin);const n=Ii.dot(this.direction),s=Ii.dot(Ii)-n*n,r=e.radius*e.radius;if(s>r)return null;const o=Math.sqrt(r-s),a=n-o,l=n+o;return l<0?null:a<0?this.at(l,t):this.at(a,t)}intersectsSphere(e){return this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){const t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;const n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){const n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){const t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,r,o,a,l;const c=1/this.direction.x,u=1/this.direction.y,h=1/this.direction.z,f=this.origin;return c>=0?(n=(e.min.x-f.x)*c,s=(e.max.x-f.x)*c):(n=(e.max.x-f.x)*c,s=(e.min.x-f.x)*c),u>=0?(r=(e.min.y-f.y)*u,o=(e.max.y-f.y)*u):(r=(e.max.y-f.y)*u,o=(e.min.y-f.y)*u),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),h>=0?(a=(e.min.z-f.z)*h,l=(e.max.z-f.z)*h):(a=(e.max.z-f.z)*h,l=(e.min.z-f.z)*h),n>l||a>s)||((a>n||n!==n)&&(n=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,Ii)!==null}intersectTriangle(e,t,n,s,r){El.subVectors(t,e),Go.subVectors(n,e),bl.crossVectors(El,Go);let o=this.direction.dot(bl),a;if(o>0){if(s)return null;a=1}else if(o<0)a=-1,o=-o;else return null;ts.subVectors(this.origin,e);const l=a*this.direction.dot(Go.crossVectors(ts,Go));if(l<0)return null;const c=a*this.direction.dot(El.cross(ts));if(c<0||l+c>o)return null;const u=-a*ts.dot(bl);return u<0?null:this.at(u/o,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}}class Nt{constructor(e,t,n,s,r,o,a,l,c,u,h,f,m,_,v,p){Nt.prototype.isMatrix4=!0,this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,o,a,l,c,u,h,f,m,_,v,p)}set(e,t,n,s,r,o,a,l,c,u,h,f,m,_,v,p){const d=this.elements;return d[0]=e,d[4]=t,d[8]=n,d[12]=s,d[1]=r,d[5]=o,d[9]=a,d[13]=l,d[2]=c,d[6]=u,d[10]=h,d[14]=f,d[3]=m,d[7]=_,d[11]=v,d[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new Nt().fromArray(this.elements)}copy(e){const t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){const t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){const t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){const t=this.elements,n=e.elements,s=1/lr.setFromMatrixColumn(e,0).length(),r=1/lr.setFromMatrixColumn(e,1).length(),o=1/lr.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*r,t[5]=n[5]*r,t[6]=n[6]*r,t[7]=0,t[8]=n[8]*o,t[9]=n[9]*o,t[10]=n[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){const t=this.elements,n=e.x,s=e.y,r=e.z,o=Math.cos(n),a=Math.sin(n),l=Math.cos(s),c=Math.sin(s),u=Math.cos(r),h=Math.sin(r);if(e.order==="XYZ"){const f=o*u,m=o*h,_=a*u,v=a*h;t[0]=l*u,t[4]=-l*h,t[8]=c,t[1]=m+_*c,t[5]=f-v*c,t[9]=-a*l,t[2]=v-f*c,t[6]=_+m*c,t[10]=o*l}else if(e.order==="YXZ"){const f=l*u,m=l*h,_=c*u,v=c*h;t[0]=f+v*a,t[4]=_*a-m,t[8]=o*c,t[1]=o*h,t[5]=o*u,t[9]=-a,t[2]=m*a-_,t[6]=v+f*a,t[10]=o*l}else if(e.order==="ZXY"){const f=l*u,m=l*h,_=c*u,v=c*h;t[0]=f-v*a,t[4]=-o*h,t[8]=_+m*a,t[1]=m+_*a,t[5]=o*u,t[9]=v-f*a,t[2]=-o*c,t[6]=a,t[10]=o*l}else if(e.order==="ZYX"){const f=o*u,m=o*h,_=a*u,v=a*h;t[0]=l*u,t[4]=_*c-m,t[8]=f*c+v,t[1]=l*h,t[5]=v*c+f,t[9]=m*c-_,t[2]=-c,t[6]=a*l,t[10]=o*l}else if(e.order==="YZX"){const f=o*l,m=o*c,_=a*l,v=a*c;t[0]=l*u,t[4]=v-f*h,t[8]=_*h+m,t[1]=h,t[5]=o*u,t[9]=-a*u,t[2]=-c*u,t[6]=m*h+_,t[10]=f-v*h}else if(e.order==="XZY"){const f=o*l,m=o*c,_=a*l,v=a*c;t[0]=l*u,t[4]=-h,t[8]=c*u,t[1]=f*h+v,t[5]=o*u,t[9]=m*h-_,t[2]=_*h-m,t[6]=a*u,t[10]=v*h+f}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(dv,e,pv)}lookAt(e,t,n){const s=this.elements;return Bn.subVectors(e,t),Bn.lengthSq()===0&&(Bn.z=1),Bn.normalize(),ns.crossVectors(n,Bn),ns.lengthSq()===0&&(Math.abs(n.z)===1?Bn.x+=1e-4:Bn.z+=1e-4,Bn.normalize(),ns.crossVectors(n,Bn)),ns.normalize(),Wo.crossVectors(Bn,ns),s[0]=ns.x,s[4]=Wo.x,s[8]=Bn.x,s[1]=ns.y,s[5]=Wo.y,s[9]=Bn.y,s[2]=ns.z,s[6]=Wo.z,s[10]=Bn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){const n=e.elements,s=t.elements,r=this.elements,o=n[0],a=n[4],l=n[8],c=n[12],u=n[1],h=n[5],f=n[9],m=n[13],_=n[2],v=n[6],p=n[10],d=n[14],b=n[3],w=n[7],M=n[11],B=n[15],D=s[0],L=s[4],U=s[8],T=s[12],y=s[1],R=s[5],K=s[9],F=s[13],G=s[2],Z=s[6],j=s[10],ee=s[14],Q=s[3],ue=s[7],ce=s[11],me=s[15];return r[0]=o*D+a*y+l*G+c*Q,r[4]=o*L+a*R+l*Z+c*ue,r[8]=o*U+a*K+l*j+c*ce,r[12]=o*T+a*F+l*ee+c*me,r[1]=u*D+h*y+f*G+m*Q,r[5]=u*L+h*R+f*Z+m*ue,r[9]=u*U+h*K+f*j+m*ce,r[13]=u*T+h*F+f*ee+m*me,r[2]=_*D+v*y+p*G+d*Q,r[6]=_*L+v*R+p*Z+d*ue,r[10]=_*U+v*K+p*j+d*ce,r[14]=_*T+v*F+p*ee+d*me,r[3]=b*D+w*y+M*G+B*Q,r[7]=b*L+w*R+M*Z+B*ue,r[11]=b*U+w*K+M*j+B*ce,r[15]=b*T+w*F+M*ee+B*me,this}multiplyScalar(e){const t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){const e=this.elements,t=e[0],n=e[4],s=e[8],r=e[12],o=e[1],a=e[5],l=e[9],c=e[13],u=e[2],h=e[6],f=e[10],m=e[14],_=e[3],v=e[7],p=e[11],d=e[15];return _*(+r*l*h-s*c*h-r*a*f+n*c*f+s*a*m-n*l*m)+v*(+t*l*m-t*c*f+r*o*f-s*o*m+s*c*u-r*l*u)+p*(+t*c*h-t*a*m-r*o*h+n*o*m+r*a*u-n*c*u)+d*(-s*a*u-t*l*h+t*a*f+s*o*h-n*o*f+n*l*u)}transpose(){const e=this.elements;let t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){const s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){const e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8],h=e[9],f=e[10],m=e[11],_=e[12],v=e[13],p=e[14],d=e[15],b=h*p*c-v*f*c+v*l*m-a*p*m-h*l*d+a*f*d,w=_*f*c-u*p*c-_*l*m+o*p*m+u*l*d-o*f*d,M=u*v*c-_*h*c+_*a*m-o*v*m-u*a*d+o*h*d,B=_*h*l-u*v*l-_*a*f+o*v*f+u*a*p-o*h*p,D=t*b+n*w+s*M+r*B;if(D===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);const L=1/D;return e[0]=b*L,e[1]=(v*f*r-h*p*r-v*s*m+n*p*m+h*s*d-n*f*d)*L,e[2]=(a*p*r-v*l*r+v*s*c-n*p*c-a*s*d+n*l*d)*L,e[3]=(h*l*r-a*f*r-h*s*c+n*f*c+a*s*m-n*l*m)*L,e[4]=w*L,e[5]=(u*p*r-_*f*r+_*s*m-t*p*m-u*s*d+t*f*d)*L,e[6]=(_*l*r-o*p*r-_*s*c+t*p*c+o*s*d-t*l*d)*L,e[7]=(o*f*r-u*l*r+u*s*c-t*f*c-o*s*m+t*l*m)*L,e[8]=M*L,e[9]=(_*h*r-u*v*r-_*n*m+t*v*m+u*n*d-t*h*d)*L,e[10]=(o*v*r-_*a*r+_*n*c-t*v*c-o*n*d+t*a*d)*L,e[11]=(u*a*r-o*h*r-u*n*c+t*h*c+o*n*m-t*a*m)*L,e[12]=B*L,e[13]=(u*v*s-_*h*s+_*n*f-t*v*f-u*n*p+t*h*p)*L,e[14]=(_*a*s-o*v*s-_*n*l+t*v*l+o*n*p-t*a*p)*L,e[15]=(o*h*s-u*a*s+u*n*l-t*h*l-o*n*f+t*a*f)*L,this}scale(e){const t=this.elements,n=e.x,s=e.y,r=e.z;return t[0]*=n,t[4]*=s,t[8]*=r,t[1]*=n,t[5]*=s,t[9]*=r,t[2]*=n,t[6]*=s,t[10]*=r,t[3]*=n,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){const e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){const t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){const t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){const t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){const n=Math.cos(t),s=Math.sin(t),r=1-n,o=e.x,a=e.y,l=e.z,c=r*o,u=r*a;return this.set(c*o+n,c*a-s*l,c*l+s*a,0,c*a+s*l,u*a+n,u*l-s*o,0,c*l-s*a,u*l+s*o,r*l*l+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,r,o){return this.set(1,n,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){const s=this.elements,r=t._x,o=t._y,a=t._z,l=t._w,c=r+r,u=o+o,h=a+a,f=r*c,m=r*u,_=r*h,v=o*u,p=o*h,d=a*h,b=l*c,w=l*u,M=l*h,B=n.x,D=n.y,L=n.z;return s[0]=(1-(v+d))*B,s[1]=(m+M)*B,s[2]=(_-w)*B,s[3]=0,s[4]=(m-M)*D,s[5]=(1-(f+d))*D,s[6]=(p+b)*D,s[7]=0,s[8]=(_+w)*L,s[9]=(p-b)*L,s[10]=(1-(f+v))*L,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){const s=this.elements;let r=lr.set(s[0],s[1],s[2]).length();const o=lr.set(s[4],s[5],s[6]).length(),a=lr.set(s[8],s[9],s[10]).length();this.determinant()<0&&(r=-r),e.x=s[12],e.y=s[13],e.z=s[14],ri.copy(this);const c=1/r,u=1/o,h=1/a;return ri.elements[0]*=c,ri.elements[1]*=c,ri.elements[2]*=c,ri.elements[4]*=u,ri.elements[5]*=u,ri.elements[6]*=u,ri.elements[8]*=h,ri.elements[9]*=h,ri.elements[10]*=h,t.setFromRotationMatrix(ri),n.x=r,n.y=o,n.z=a,this}makePerspective(e,t,n,s,r,o,a=Vi){const l=this.elements,c=2*r/(t-e),u=2*r/(n-s),h=(t+e)/(t-e),f=(n+s)/(n-s);let m,_;if(a===Vi)m=-(o+r)/(o-r),_=-2*o*r/(o-r);else if(a===Ea)m=-o/(o-r),_=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return l[0]=c,l[4]=0,l[8]=h,l[12]=0,l[1]=0,l[5]=u,l[9]=f,l[13]=0,l[2]=0,l[6]=0,l[10]=m,l[14]=_,l[3]=0,l[7]=0,l[11]=-1,l[15]=0,this}makeOrthographic(e,t,n,s,r,o,a=Vi){const l=this.elements,c=1/(t-e),u=1/(n-s),h=1/(o-r),f=(t+e)*c,m=(n+s)*u;let _,v;if(a===Vi)_=(o+r)*h,v=-2*h;else if(a===Ea)_=r*h,v=-1*h;else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return l[0]=2*c,l[4]=0,l[8]=0,l[12]=-f,l[1]=0,l[5]=2*u,l[9]=0,l[13]=-m,l[2]=0,l[6]=0,l[10]=v,l[14]=-_,l[3]=0,l[7]=0,l[11]=0,l[15]=1,this}equals(e){const t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){const n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}}const lr=new H,ri=new Nt,dv=new H(0,0,0),pv=new H(1,1,1),ns=new H,Wo=new H,Bn=new H,af=new Nt,lf=new ms;class qi{constructor(e=0,t=0,n=0,s=qi.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=n,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,s=this._order){return this._x=e,this._y=t,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){const s=e.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],u=s[9],h=s[2],f=s[6],m=s[10];switch(t){case"XYZ":this._y=Math.asin(gn(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-u,m),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(f,c),this._z=0);break;case"YXZ":this._x=Math.asin(-gn(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(a,m),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-h,r),this._z=0);break;case"ZXY":this._x=Math.asin(gn(f,-1,1)),Math.abs(f)<.9999999?(this._y=Math.atan2(-h,m),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-gn(h,-1,1)),Math.abs(h)<.9999999?(this._x=Math.atan2(f,m),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(gn(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-u,c),this._y=Math.atan2(-h,r)):(this._x=0,this._y=Math.atan2(a,m));break;case"XZY":this._z=Math.asin(-gn(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(f,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-u,m),this._y=0);break;default:console.warn("THREE.Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return af.makeRotationFromQuaternion(e),this.setFromRotationMatrix(af,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return lf.setFromEuler(this),this.setFromQuaternion(lf,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}}qi.DEFAULT_ORDER="XYZ";class Tp{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}}let mv=0;const cf=new H,cr=new ms,Ni=new Nt,Xo=new H,to=new H,gv=new H,_v=new ms,hf=new H(1,0,0),uf=new H(0,1,0),ff=new H(0,0,1),df={type:"added"},vv={type:"removed"},hr={type:"childadded",child:null},Tl={type:"childremoved",child:null};class An extends Hs{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:mv++}),this.uuid=Wi(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=An.DEFAULT_UP.clone();const e=new H,t=new qi,n=new ms,s=new H(1,1,1);function r(){n.setFromEuler(t,!1)}function o(){t.setFromQuaternion(n,void 0,!1)}t._onChange(r),n._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Nt},normalMatrix:{value:new Je}}),this.matrix=new Nt,this.matrixWorld=new Nt,this.matrixAutoUpdate=An.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=An.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Tp,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.userData={}}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return cr.setFromAxisAngle(e,t),this.quaternion.multiply(cr),this}rotateOnWorldAxis(e,t){return cr.setFromAxisAngle(e,t),this.quaternion.premultiply(cr),this}rotateX(e){return this.rotateOnAxis(hf,e)}rotateY(e){return this.rotateOnAxis(uf,e)}rotateZ(e){return this.rotateOnAxis(ff,e)}translateOnAxis(e,t){return cf.copy(e).applyQuaternion(this.quaternion),this.position.add(cf.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(hf,e)}translateY(e){return this.translateOnAxis(uf,e)}translateZ(e){return this.translateOnAxis(ff,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Ni.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Xo.copy(e):Xo.set(e,t,n);const s=this.parent;this.updateWorldMatrix(!0,!1),to.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Ni.lookAt(to,Xo,this.up):Ni.lookAt(Xo,to,this.up),this.quaternion.setFromRotationMatrix(Ni),s&&(Ni.extractRotation(s.matrixWorld),cr.setFromRotationMatrix(Ni),this.quaternion.premultiply(cr.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(console.error("THREE.Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(df),hr.child=e,this.dispatchEvent(hr),hr.child=null):console.error("THREE.Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}const t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(vv),Tl.child=e,this.dispatchEvent(Tl),Tl.child=null),this}removeFromParent(){const e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Ni.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Ni.multiply(e.parent.matrixWorld)),e.applyMatrix4(Ni),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(df),hr.child=e,this.dispatchEvent(hr),hr.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){const o=this.children[n].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);const s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(to,e,gv),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(to,_v,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);const t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}traverse(e){e(this);const t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);const t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){const t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale),this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);const t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t){const n=this.parent;if(e===!0&&n!==null&&n.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),t===!0){const s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].updateWorldMatrix(!1,!0)}}toJSON(e){const t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.6,type:"Object",generator:"Object3D.toJSON"});const s={};s.uuid=this.uuid,s.type=this.type,this.name!==""&&(s.name=this.name),this.castShadow===!0&&(s.castShadow=!0),this.receiveShadow===!0&&(s.receiveShadow=!0),this.visible===!1&&(s.visible=!1),this.frustumCulled===!1&&(s.frustumCulled=!1),this.renderOrder!==0&&(s.renderOrder=this.renderOrder),Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.matrixAutoUpdate===!1&&(s.matrixAutoUpdate=!1),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.visibility=this._visibility,s.active=this._active,s.bounds=this._bounds.map(a=>({boxInitialized:a.boxInitialized,boxMin:a.box.min.toArray(),boxMax:a.box.max.toArray(),sphereInitialized:a.sphereInitialized,sphereRadius:a.sphere.radius,sphereCenter:a.sphere.center.toArray()})),s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.geometryCount=this._geometryCount,s.matricesTexture=this._matricesTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere={center:s.boundingSphere.center.toArray(),radius:s.boundingSphere.radius}),this.boundingBox!==null&&(s.boundingBox={min:s.boundingBox.min.toArray(),max:s.boundingBox.max.toArray()}));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);const a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){const l=a.shapes;if(Array.isArray(l))for(let c=0,u=l.length;c<u;c++){const h=l[c];r(e.shapes,h)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){const a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(e.materials,this.material[l]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){const l=this.animations[a];s.animations.push(r(e.animations,l))}}if(t){const a=o(e.geometries),l=o(e.materials),c=o(e.textures),u=o(e.images),h=o(e.shapes),f=o(e.skeletons),m=o(e.animations),_=o(e.nodes);a.length>0&&(n.geometries=a),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),u.length>0&&(n.images=u),h.length>0&&(n.shapes=h),f.length>0&&(n.skeletons=f),m.length>0&&(n.animations=m),_.length>0&&(n.nodes=_)}return n.object=s,n;function o(a){const l=[];for(const c in a){const u=a[c];delete u.metadata,l.push(u)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){const s=e.children[n];this.add(s.clone())}return this}}An.DEFAULT_UP=new H(0,1,0);An.DEFAULT_MATRIX_AUTO_UPDATE=!0;An.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;const oi=new H,Fi=new H,wl=new H,Oi=new H,ur=new H,fr=new H,pf=new H,Al=new H,Cl=new H,Rl=new H,Pl=new Gt,Dl=new Gt,Ll=new Gt;class fi{constructor(e=new H,t=new H,n=new H){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),oi.subVectors(e,t),s.cross(oi);const r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,n,s,r){oi.subVectors(s,t),Fi.subVectors(n,t),wl.subVectors(e,t);const o=oi.dot(oi),a=oi.dot(Fi),l=oi.dot(wl),c=Fi.dot(Fi),u=Fi.dot(wl),h=o*c-a*a;if(h===0)return r.set(0,0,0),null;const f=1/h,m=(c*l-a*u)*f,_=(o*u-a*l)*f;return r.set(1-m-_,_,m)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,Oi)===null?!1:Oi.x>=0&&Oi.y>=0&&Oi.x+Oi.y<=1}static getInterpolation(e,t,n,s,r,o,a,l){return this.getBarycoord(e,t,n,s,Oi)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,Oi.x),l.addScaledVector(o,Oi.y),l.addScaledVector(a,Oi.z),l)}static getInterpolatedAttribute(e,t,n,s,r,o){return Pl.setScalar(0),Dl.setScalar(0),Ll.setScalar(0),Pl.fromBufferAttribute(e,t),Dl.fromBufferAttribute(e,n),Ll.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(Pl,r.x),o.addScaledVector(Dl,r.y),o.addScaledVector(Ll,r.z),o}static isFrontFacing(e,t,n,s){return oi.subVectors(n,t),Fi.subVectors(e,t),oi.cross(Fi).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return oi.subVectors(this.c,this.b),Fi.subVectors(this.a,this.b),oi.cross(Fi).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return fi.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return fi.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,r){return fi.getInterpolation(e,this.a,this.b,this.c,t,n,s,r)}containsPoint(e){return fi.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return fi.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){const n=this.a,s=this.b,r=this.c;let o,a;ur.subVectors(s,n),fr.subVectors(r,n),Al.subVectors(e,n);const l=ur.dot(Al),c=fr.dot(Al);if(l<=0&&c<=0)return t.copy(n);Cl.subVectors(e,s);const u=ur.dot(Cl),h=fr.dot(Cl);if(u>=0&&h<=u)return t.copy(s);const f=l*h-u*c;if(f<=0&&l>=0&&u<=0)return o=l/(l-u),t.copy(n).addScaledVector(ur,o);Rl.subVectors(e,r);const m=ur.dot(Rl),_=fr.dot(Rl);if(_>=0&&m<=_)return t.copy(r);const v=m*c-l*_;if(v<=0&&c>=0&&_<=0)return a=c/(c-_),t.copy(n).addScaledVector(fr,a);const p=u*_-m*h;if(p<=0&&h-u>=0&&m-_>=0)return pf.subVectors(r,s),a=(h-u)/(h-u+(m-_)),t.copy(s).addScaledVector(pf,a);const d=1/(p+v+f);return o=v*d,a=f*d,t.copy(n).addScaledVector(ur,o).addScaledVector(fr,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}}const wp={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},is={h:0,s:0,l:0},Yo={h:0,s:0,l:0};function Ul(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}class xt{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){const s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=Gn){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,ft.toWorkingColorSpace(this,t),this}setRGB(e,t,n,s=ft.workingColorSpace){return this.r=e,this.g=t,this.b=n,ft.toWorkingColorSpace(this,s),this}setHSL(e,t,n,s=ft.workingColorSpace){if(e=yh(e,1),t=gn(t,0,1),n=gn(n,0,1),t===0)this.r=this.g=this.b=n;else{const r=n<=.5?n*(1+t):n+t-n*t,o=2*n-r;this.r=Ul(o,r,e+1/3),this.g=Ul(o,r,e),this.b=Ul(o,r,e-1/3)}return ft.toWorkingColorSpace(this,s),this}setStyle(e,t=Gn){function n(r){r!==void 0&&parseFloat(r)<1&&console.warn("THREE.Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r;const o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+)\%\s*,\s*(\d+)\%\s*,\s*(\d+)\%\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(100,parseInt(r[1],10))/100,Math.min(100,parseInt(r[2],10))/100,Math.min(100,parseInt(r[3],10))/100,t);break;case"hsl":case"hsla":if(r=/^\s*(\d*\.?\d+)\s*,\s*(\d*\.?\d+)\%\s*,\s*(\d*\.?\d+)\%\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:console.warn("THREE.Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){const r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);console.warn("THREE.Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=Gn){const n=wp[e.toLowerCase()];return n!==void 0?this.setHex(n,t):console.warn("THREE.Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Xi(e.r),this.g=Xi(e.g),this.b=Xi(e.b),this}copyLinearToSRGB(e){return this.r=br(e.r),this.g=br(e.g),this.b=br(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=Gn){return ft.fromWorkingColorSpace(pn.copy(this),e),Math.round(gn(pn.r*255,0,255))*65536+Math.round(gn(pn.g*255,0,255))*256+Math.round(gn(pn.b*255,0,255))}getHexString(e=Gn){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=ft.workingColorSpace){ft.fromWorkingColorSpace(pn.copy(this),t);const n=pn.r,s=pn.g,r=pn.b,o=Math.max(n,s,r),a=Math.min(n,s,r);let l,c;const u=(a+o)/2;if(a===o)l=0,c=0;else{const h=o-a;switch(c=u<=.5?h/(o+a):h/(2-o-a),o){case n:l=(s-r)/h+(s<r?6:0);break;case s:l=(r-n)/h+2;break;case r:l=(n-s)/h+4;break}l/=6}return e.h=l,e.s=c,e.l=u,e}getRGB(e,t=ft.workingColorSpace){return ft.fromWorkingColorSpace(pn.copy(this),t),e.r=pn.r,e.g=pn.g,e.b=pn.b,e}getStyle(e=Gn){ft.fromWorkingColorSpace(pn.copy(this),e);const t=pn.r,n=pn.g,s=pn.b;return e!==Gn?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(is),this.setHSL(is.h+e,is.s+t,is.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(is),e.getHSL(Yo);const n=mo(is.h,Yo.h,t),s=mo(is.s,Yo.s,t),r=mo(is.l,Yo.l,t);return this.setHSL(n,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){const t=this.r,n=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*n+r[6]*s,this.g=r[1]*t+r[4]*n+r[7]*s,this.b=r[2]*t+r[5]*n+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}}const pn=new xt;xt.NAMES=wp;let xv=0;class Vr extends Hs{static get type(){return"Material"}get type(){return this.constructor.type}set type(e){}constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:xv++}),this.uuid=Wi(),this.name="",this.blending=yr,this.side=ps,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=lc,this.blendDst=cc,this.blendEquation=Ls,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new xt(0,0,0),this.blendAlpha=0,this.depthFunc=Pr,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=Zu,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=ir,this.stencilZFail=ir,this.stencilZPass=ir,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(const t in e){const n=e[t];if(n===void 0){console.warn(`THREE.Material: parameter '${t}' has value of undefined.`);continue}const s=this[t];if(s===void 0){console.warn(`THREE.Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){const t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});const n={metadata:{version:4.6,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,this.name!==""&&(n.name=this.name),this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&this.emissiveIntensity!==1&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessRange!==void 0&&(n.iridescenceThicknessRange=this.iridescenceThicknessRange),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&this.attenuationDistance!==1/0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.shadowSide!==null&&(n.shadowSide=this.shadowSide),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),this.blending!==yr&&(n.blending=this.blending),this.side!==ps&&(n.side=this.side),this.vertexColors===!0&&(n.vertexColors=!0),this.opacity<1&&(n.opacity=this.opacity),this.transparent===!0&&(n.transparent=!0),this.blendSrc!==lc&&(n.blendSrc=this.blendSrc),this.blendDst!==cc&&(n.blendDst=this.blendDst),this.blendEquation!==Ls&&(n.blendEquation=this.blendEquation),this.blendSrcAlpha!==null&&(n.blendSrcAlpha=this.blendSrcAlpha),this.blendDstAlpha!==null&&(n.blendDstAlpha=this.blendDstAlpha),this.blendEquationAlpha!==null&&(n.blendEquationAlpha=this.blendEquationAlpha),this.blendColor&&this.blendColor.isColor&&(n.blendColor=this.blendColor.getHex()),this.blendAlpha!==0&&(n.blendAlpha=this.blendAlpha),this.depthFunc!==Pr&&(n.depthFunc=this.depthFunc),this.depthTest===!1&&(n.depthTest=this.depthTest),this.depthWrite===!1&&(n.depthWrite=this.depthWrite),this.colorWrite===!1&&(n.colorWrite=this.colorWrite),this.stencilWriteMask!==255&&(n.stencilWriteMask=this.stencilWriteMask),this.stencilFunc!==Zu&&(n.stencilFunc=this.stencilFunc),this.stencilRef!==0&&(n.stencilRef=this.stencilRef),this.stencilFuncMask!==255&&(n.stencilFuncMask=this.stencilFuncMask),this.stencilFail!==ir&&(n.stencilFail=this.stencilFail),this.stencilZFail!==ir&&(n.stencilZFail=this.stencilZFail),this.stencilZPass!==ir&&(n.stencilZPass=this.stencilZPass),this.stencilWrite===!0&&(n.stencilWrite=this.stencilWrite),this.rotation!==void 0&&this.rotation!==0&&(n.rotation=this.rotation),this.polygonOffset===!0&&(n.polygonOffset=!0),this.polygonOffsetFactor!==0&&(n.polygonOffsetFactor=this.polygonOffsetFactor),this.polygonOffsetUnits!==0&&(n.polygonOffsetUnits=this.polygonOffsetUnits),this.linewidth!==void 0&&this.linewidth!==1&&(n.linewidth=this.linewidth),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.dithering===!0&&(n.dithering=!0),this.alphaTest>0&&(n.alphaTest=this.alphaTest),this.alphaHash===!0&&(n.alphaHash=!0),this.alphaToCoverage===!0&&(n.alphaToCoverage=!0),this.premultipliedAlpha===!0&&(n.premultipliedAlpha=!0),this.forceSinglePass===!0&&(n.forceSinglePass=!0),this.wireframe===!0&&(n.wireframe=!0),this.wireframeLinewidth>1&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!=="round"&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!=="round"&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading===!0&&(n.flatShading=!0),this.visible===!1&&(n.visible=!1),this.toneMapped===!1&&(n.toneMapped=!1),this.fog===!1&&(n.fog=!1),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){const o=[];for(const a in r){const l=r[a];delete l.metadata,o.push(l)}return o}if(t){const r=s(e.textures),o=s(e.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;const t=e.clippingPlanes;let n=null;if(t!==null){const s=t.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}onBuild(){console.warn("Material: onBuild() has been removed.")}}class Ap extends Vr{static get type(){return"MeshBasicMaterial"}constructor(e){super(),this.isMeshBasicMaterial=!0,this.color=new xt(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new qi,this.combine=cp,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}}const Xt=new H,qo=new nt;class Cn{constructor(e,t,n=!1){if(Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=qc,this.updateRanges=[],this.gpuType=zi,this.version=0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)qo.fromBufferAttribute(this,t),qo.applyMatrix3(e),this.setXY(t,qo.x,qo.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyMatrix3(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyMatrix4(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyNormalMatrix(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.transformDirection(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=ui(n,this.array)),n}setComponent(e,t,n){return this.normalized&&(n=Et(n,this.array)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=ui(t,this.array)),t}setX(e,t){return this.normalized&&(t=Et(t,this.array)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=ui(t,this.array)),t}setY(e,t){return this.normalized&&(t=Et(t,this.array)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=ui(t,this.array)),t}setZ(e,t){return this.normalized&&(t=Et(t,this.array)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=ui(t,this.array)),t}setW(e,t){return this.normalized&&(t=Et(t,this.array)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array),s=Et(s,this.array)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e*=this.itemSize,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array),s=Et(s,this.array),r=Et(r,this.array)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){const e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return this.name!==""&&(e.name=this.name),this.usage!==qc&&(e.usage=this.usage),e}}class Cp extends Cn{constructor(e,t,n){super(new Uint16Array(e),t,n)}}class Rp extends Cn{constructor(e,t,n){super(new Uint32Array(e),t,n)}}class fs extends Cn{constructor(e,t,n){super(new Float32Array(e),t,n)}}let Sv=0;const Zn=new Nt,Il=new An,dr=new H,kn=new bo,no=new bo,cn=new H;class vn extends Hs{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Sv++}),this.uuid=Wi(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={}}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(yp(e)?Rp:Cp)(e,1):this.index=e,this}setIndirect(e){return this.indirect=e,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){const t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);const n=this.attributes.normal;if(n!==void 0){const r=new Je().getNormalMatrix(e);n.applyNormalMatrix(r),n.needsUpdate=!0}const s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this}applyQuaternion(e){return Zn.makeRotationFromQuaternion(e),this.applyMatrix4(Zn),this}rotateX(e){return Zn.makeRotationX(e),this.applyMatrix4(Zn),this}rotateY(e){return Zn.makeRotationY(e),this.applyMatrix4(Zn),this}rotateZ(e){return Zn.makeRotationZ(e),this.applyMatrix4(Zn),this}translate(e,t,n){return Zn.makeTranslation(e,t,n),this.applyMatrix4(Zn),this}scale(e,t,n){return Zn.makeScale(e,t,n),this.applyMatrix4(Zn),this}lookAt(e){return Il.lookAt(e),Il.updateMatrix(),this.applyMatrix4(Il.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(dr).negate(),this.translate(dr.x,dr.y,dr.z),this}setFromPoints(e){const t=this.getAttribute("position");if(t===void 0){const n=[];for(let s=0,r=e.length;s<r;s++){const o=e[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new fs(n,3))}else{for(let n=0,s=t.count;n<s;n++){const r=e[n];t.setXYZ(n,r.x,r.y,r.z||0)}e.length>t.count&&console.warn("THREE.BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new bo);const e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){console.error("THREE.BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new H(-1/0,-1/0,-1/0),new H(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){const r=t[n];kn.setFromBufferAttribute(r),this.morphTargetsRelative?(cn.addVectors(this.boundingBox.min,kn.min),this.boundingBox.expandByPoint(cn),cn.addVectors(this.boundingBox.max,kn.max),this.boundingBox.expandByPoint(cn)):(this.boundingBox.expandByPoint(kn.min),this.boundingBox.expandByPoint(kn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&console.error('THREE.BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new To);const e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){console.error("THREE.BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new H,1/0);return}if(e){const n=this.boundingSphere.center;if(kn.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){const a=t[r];no.setFromBufferAttribute(a),this.morphTargetsRelative?(cn.addVectors(kn.min,no.min),kn.expandByPoint(cn),cn.addVectors(kn.max,no.max),kn.expandByPoint(cn)):(kn.expandByPoint(no.min),kn.expandByPoint(no.max))}kn.getCenter(n);let s=0;for(let r=0,o=e.count;r<o;r++)cn.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(cn));if(t)for(let r=0,o=t.length;r<o;r++){const a=t[r],l=this.morphTargetsRelative;for(let c=0,u=a.count;c<u;c++)cn.fromBufferAttribute(a,c),l&&(dr.fromBufferAttribute(e,c),cn.add(dr)),s=Math.max(s,n.distanceToSquared(cn))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&console.error('THREE.BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){const e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){console.error("THREE.BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}const n=t.position,s=t.normal,r=t.uv;this.hasAttribute("tangent")===!1&&this.setAttribute("tangent",new Cn(new Float32Array(4*n.count),4));const o=this.getAttribute("tangent"),a=[],l=[];for(let U=0;U<n.count;U++)a[U]=new H,l[U]=new H;const c=new H,u=new H,h=new H,f=new nt,m=new nt,_=new nt,v=new H,p=new H;function d(U,T,y){c.fromBufferAttribute(n,U),u.fromBufferAttribute(n,T),h.fromBufferAttribute(n,y),f.fromBufferAttribute(r,U),m.fromBufferAttribute(r,T),_.fromBufferAttribute(r,y),u.sub(c),h.sub(c),m.sub(f),_.sub(f);const R=1/(m.x*_.y-_.x*m.y);isFinite(R)&&(v.copy(u).multiplyScalar(_.y).addScaledVector(h,-m.y).multiplyScalar(R),p.copy(h).multiplyScalar(m.x).addScaledVector(u,-_.x).multiplyScalar(R),a[U].add(v),a[T].add(v),a[y].add(v),l[U].add(p),l[T].add(p),l[y].add(p))}let b=this.groups;b.length===0&&(b=[{start:0,count:e.count}]);for(let U=0,T=b.length;U<T;++U){const y=b[U],R=y.start,K=y.count;for(let F=R,G=R+K;F<G;F+=3)d(e.getX(F+0),e.getX(F+1),e.getX(F+2))}const w=new H,M=new H,B=new H,D=new H;function L(U){B.fromBufferAttribute(s,U),D.copy(B);const T=a[U];w.copy(T),w.sub(B.multiplyScalar(B.dot(T))).normalize(),M.crossVectors(D,T);const R=M.dot(l[U])<0?-1:1;o.setXYZW(U,w.x,w.y,w.z,R)}for(let U=0,T=b.length;U<T;++U){const y=b[U],R=y.start,K=y.count;for(let F=R,G=R+K;F<G;F+=3)L(e.getX(F+0)),L(e.getX(F+1)),L(e.getX(F+2))}}computeVertexNormals(){const e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0)n=new Cn(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let f=0,m=n.count;f<m;f++)n.setXYZ(f,0,0,0);const s=new H,r=new H,o=new H,a=new H,l=new H,c=new H,u=new H,h=new H;if(e)for(let f=0,m=e.count;f<m;f+=3){const _=e.getX(f+0),v=e.getX(f+1),p=e.getX(f+2);s.fromBufferAttribute(t,_),r.fromBufferAttribute(t,v),o.fromBufferAttribute(t,p),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),a.fromBufferAttribute(n,_),l.fromBufferAttribute(n,v),c.fromBufferAttribute(n,p),a.add(u),l.add(u),c.add(u),n.setXYZ(_,a.x,a.y,a.z),n.setXYZ(v,l.x,l.y,l.z),n.setXYZ(p,c.x,c.y,c.z)}else for(let f=0,m=t.count;f<m;f+=3)s.fromBufferAttribute(t,f+0),r.fromBufferAttribute(t,f+1),o.fromBufferAttribute(t,f+2),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),n.setXYZ(f+0,u.x,u.y,u.z),n.setXYZ(f+1,u.x,u.y,u.z),n.setXYZ(f+2,u.x,u.y,u.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){const e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)cn.fromBufferAttribute(e,t),cn.normalize(),e.setXYZ(t,cn.x,cn.y,cn.z)}toNonIndexed(){function e(a,l){const c=a.array,u=a.itemSize,h=a.normalized,f=new c.constructor(l.length*u);let m=0,_=0;for(let v=0,p=l.length;v<p;v++){a.isInterleavedBufferAttribute?m=l[v]*a.data.stride+a.offset:m=l[v]*u;for(let d=0;d<u;d++)f[_++]=c[m++]}return new Cn(f,u,h)}if(this.index===null)return console.warn("THREE.BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;const t=new vn,n=this.index.array,s=this.attributes;for(const a in s){const l=s[a],c=e(l,n);t.setAttribute(a,c)}const r=this.morphAttributes;for(const a in r){const l=[],c=r[a];for(let u=0,h=c.length;u<h;u++){const f=c[u],m=e(f,n);l.push(m)}t.morphAttributes[a]=l}t.morphTargetsRelative=this.morphTargetsRelative;const o=this.groups;for(let a=0,l=o.length;a<l;a++){const c=o[a];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){const e={metadata:{version:4.6,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.type,this.name!==""&&(e.name=this.name),Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0){const l=this.parameters;for(const c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};const t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});const n=this.attributes;for(const l in n){const c=n[l];e.data.attributes[l]=c.toJSON(e.data)}const s={};let r=!1;for(const l in this.morphAttributes){const c=this.morphAttributes[l],u=[];for(let h=0,f=c.length;h<f;h++){const m=c[h];u.push(m.toJSON(e.data))}u.length>0&&(s[l]=u,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);const o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));const a=this.boundingSphere;return a!==null&&(e.data.boundingSphere={center:a.center.toArray(),radius:a.radius}),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;const t={};this.name=e.name;const n=e.index;n!==null&&this.setIndex(n.clone(t));const s=e.attributes;for(const c in s){const u=s[c];this.setAttribute(c,u.clone(t))}const r=e.morphAttributes;for(const c in r){const u=[],h=r[c];for(let f=0,m=h.length;f<m;f++)u.push(h[f].clone(t));this.morphAttributes[c]=u}this.morphTargetsRelative=e.morphTargetsRelative;const o=e.groups;for(let c=0,u=o.length;c<u;c++){const h=o[c];this.addGroup(h.start,h.count,h.materialIndex)}const a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());const l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this}dispose(){this.dispatchEvent({type:"dispose"})}}const mf=new Nt,bs=new Ha,jo=new To,gf=new H,Ko=new H,Zo=new H,$o=new H,Nl=new H,Jo=new H,_f=new H,Qo=new H;class Ai extends An{constructor(e=new vn,t=new Ap){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0&&(this.morphTargetInfluences=e.morphTargetInfluences.slice()),e.morphTargetDictionary!==void 0&&(this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary)),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){const t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){const s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){const a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){const n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;t.fromBufferAttribute(s,e);const a=this.morphTargetInfluences;if(r&&a){Jo.set(0,0,0);for(let l=0,c=r.length;l<c;l++){const u=a[l],h=r[l];u!==0&&(Nl.fromBufferAttribute(h,e),o?Jo.addScaledVector(Nl,u):Jo.addScaledVector(Nl.sub(t),u))}t.add(Jo)}return t}raycast(e,t){const n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),jo.copy(n.boundingSphere),jo.applyMatrix4(r),bs.copy(e.ray).recast(e.near),!(jo.containsPoint(bs.origin)===!1&&(bs.intersectSphere(jo,gf)===null||bs.origin.distanceToSquared(gf)>(e.far-e.near)**2))&&(mf.copy(r).invert(),bs.copy(e.ray).applyMatrix4(mf),!(n.boundingBox!==null&&bs.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(e,t,bs)))}_computeIntersections(e,t,n){let s;const r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,u=r.attributes.uv1,h=r.attributes.normal,f=r.groups,m=r.drawRange;if(a!==null)if(Array.isArray(o))for(let _=0,v=f.length;_<v;_++){const p=f[_],d=o[p.materialIndex],b=Math.max(p.start,m.start),w=Math.min(a.count,Math.min(p.start+p.count,m.start+m.count));for(let M=b,B=w;M<B;M+=3){const D=a.getX(M),L=a.getX(M+1),U=a.getX(M+2);s=ea(this,d,e,n,c,u,h,D,L,U),s&&(s.faceIndex=Math.floor(M/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{const _=Math.max(0,m.start),v=Math.min(a.count,m.start+m.count);for(let p=_,d=v;p<d;p+=3){const b=a.getX(p),w=a.getX(p+1),M=a.getX(p+2);s=ea(this,o,e,n,c,u,h,b,w,M),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let _=0,v=f.length;_<v;_++){const p=f[_],d=o[p.materialIndex],b=Math.max(p.start,m.start),w=Math.min(l.count,Math.min(p.start+p.count,m.start+m.count));for(let M=b,B=w;M<B;M+=3){const D=M,L=M+1,U=M+2;s=ea(this,d,e,n,c,u,h,D,L,U),s&&(s.faceIndex=Math.floor(M/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{const _=Math.max(0,m.start),v=Math.min(l.count,m.start+m.count);for(let p=_,d=v;p<d;p+=3){const b=p,w=p+1,M=p+2;s=ea(this,o,e,n,c,u,h,b,w,M),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}}function Mv(i,e,t,n,s,r,o,a){let l;if(e.side===Ln?l=n.intersectTriangle(o,r,s,!0,a):l=n.intersectTriangle(s,r,o,e.side===ps,a),l===null)return null;Qo.copy(a),Qo.applyMatrix4(i.matrixWorld);const c=t.ray.origin.distanceTo(Qo);return c<t.near||c>t.far?null:{distance:c,point:Qo.clone(),object:i}}function ea(i,e,t,n,s,r,o,a,l,c){i.getVertexPosition(a,Ko),i.getVertexPosition(l,Zo),i.getVertexPosition(c,$o);const u=Mv(i,e,t,n,Ko,Zo,$o,_f);if(u){const h=new H;fi.getBarycoord(_f,Ko,Zo,$o,h),s&&(u.uv=fi.getInterpolatedAttribute(s,a,l,c,h,new nt)),r&&(u.uv1=fi.getInterpolatedAttribute(r,a,l,c,h,new nt)),o&&(u.normal=fi.getInterpolatedAttribute(o,a,l,c,h,new H),u.normal.dot(n.direction)>0&&u.normal.multiplyScalar(-1));const f={a,b:l,c,normal:new H,materialIndex:0};fi.getNormal(Ko,Zo,$o,f.normal),u.face=f,u.barycoord=h}return u}class wo extends vn{constructor(e=1,t=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};const a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);const l=[],c=[],u=[],h=[];let f=0,m=0;_("z","y","x",-1,-1,n,t,e,o,r,0),_("z","y","x",1,-1,n,t,-e,o,r,1),_("x","z","y",1,1,e,n,t,s,o,2),_("x","z","y",1,-1,e,n,-t,s,o,3),_("x","y","z",1,-1,e,t,n,s,r,4),_("x","y","z",-1,-1,e,t,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new fs(c,3)),this.setAttribute("normal",new fs(u,3)),this.setAttribute("uv",new fs(h,2));function _(v,p,d,b,w,M,B,D,L,U,T){const y=M/L,R=B/U,K=M/2,F=B/2,G=D/2,Z=L+1,j=U+1;let ee=0,Q=0;const ue=new H;for(let ce=0;ce<j;ce++){const me=ce*R-F;for(let Se=0;Se<Z;Se++){const pe=Se*y-K;ue[v]=pe*b,ue[p]=me*w,ue[d]=G,c.push(ue.x,ue.y,ue.z),ue[v]=0,ue[p]=0,ue[d]=D>0?1:-1,u.push(ue.x,ue.y,ue.z),h.push(Se/L),h.push(1-ce/U),ee+=1}}for(let ce=0;ce<U;ce++)for(let me=0;me<L;me++){const Se=f+me+Z*ce,pe=f+me+Z*(ce+1),ie=f+(me+1)+Z*(ce+1),ae=f+(me+1)+Z*ce;l.push(Se,pe,ae),l.push(pe,ie,ae),Q+=6}a.addGroup(m,Q,T),m+=Q,f+=ee}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new wo(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}}function Nr(i){const e={};for(const t in i){e[t]={};for(const n in i[t]){const s=i[t][n];s&&(s.isColor||s.isMatrix3||s.isMatrix4||s.isVector2||s.isVector3||s.isVector4||s.isTexture||s.isQuaternion)?s.isRenderTargetTexture?(console.warn("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone():Array.isArray(s)?e[t][n]=s.slice():e[t][n]=s}}return e}function bn(i){const e={};for(let t=0;t<i.length;t++){const n=Nr(i[t]);for(const s in n)e[s]=n[s]}return e}function yv(i){const e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function Pp(i){const e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:ft.workingColorSpace}const Ev={clone:Nr,merge:bn};var bv=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Tv=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`;class Ci extends Vr{static get type(){return"ShaderMaterial"}constructor(e){super(),this.isShaderMaterial=!0,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=bv,this.fragmentShader=Tv,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Nr(e.uniforms),this.uniformsGroups=yv(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this}toJSON(e){const t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(const s in this.uniforms){const o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;const n={};for(const s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}}class Dp extends An{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Nt,this.projectionMatrix=new Nt,this.projectionMatrixInverse=new Nt,this.coordinateSystem=Vi}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorldInverse.copy(this.matrixWorld).invert()}updateWorldMatrix(e,t){super.updateWorldMatrix(e,t),this.matrixWorldInverse.copy(this.matrixWorld).invert()}clone(){return new this.constructor().copy(this)}}const ss=new H,vf=new nt,xf=new nt;class ei extends Dp{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){const t=.5*this.getFilmHeight()/e;this.fov=xo*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){const e=Math.tan(po*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return xo*2*Math.atan(Math.tan(po*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){ss.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(ss.x,ss.y).multiplyScalar(-e/ss.z),ss.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(ss.x,ss.y).multiplyScalar(-e/ss.z)}getViewSize(e,t){return this.getViewBounds(e,vf,xf),t.subVectors(xf,vf)}setViewOffset(e,t,n,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){const e=this.near;let t=e*Math.tan(po*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,r=-.5*s;const o=this.view;if(this.view!==null&&this.view.enabled){const l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,t-=o.offsetY*n/c,s*=o.width/l,n*=o.height/c}const a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-n,e,this.far,this.coordinateSystem),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){const t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}}const pr=-90,mr=1;class wv extends An{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;const s=new ei(pr,mr,e,t);s.layers=this.layers,this.add(s);const r=new ei(pr,mr,e,t);r.layers=this.layers,this.add(r);const o=new ei(pr,mr,e,t);o.layers=this.layers,this.add(o);const a=new ei(pr,mr,e,t);a.layers=this.layers,this.add(a);const l=new ei(pr,mr,e,t);l.layers=this.layers,this.add(l);const c=new ei(pr,mr,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){const e=this.coordinateSystem,t=this.children.concat(),[n,s,r,o,a,l]=t;for(const c of t)this.remove(c);if(e===Vi)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===Ea)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(const c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();const{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());const[r,o,a,l,c,u]=this.children,h=e.getRenderTarget(),f=e.getActiveCubeFace(),m=e.getActiveMipmapLevel(),_=e.xr.enabled;e.xr.enabled=!1;const v=n.texture.generateMipmaps;n.texture.generateMipmaps=!1,e.setRenderTarget(n,0,s),e.render(t,r),e.setRenderTarget(n,1,s),e.render(t,o),e.setRenderTarget(n,2,s),e.render(t,a),e.setRenderTarget(n,3,s),e.render(t,l),e.setRenderTarget(n,4,s),e.render(t,c),n.texture.generateMipmaps=v,e.setRenderTarget(n,5,s),e.render(t,u),e.setRenderTarget(h,f,m),e.xr.enabled=_,n.texture.needsPMREMUpdate=!0}}class Lp extends wn{constructor(e,t,n,s,r,o,a,l,c,u){e=e!==void 0?e:[],t=t!==void 0?t:Dr,super(e,t,n,s,r,o,a,l,c,u),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}}class Av extends ks{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;const n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new Lp(s,t.mapping,t.wrapS,t.wrapT,t.magFilter,t.minFilter,t.format,t.type,t.anisotropy,t.colorSpace),this.texture.isRenderTargetTexture=!0,this.texture.generateMipmaps=t.generateMipmaps!==void 0?t.generateMipmaps:!1,this.texture.minFilter=t.minFilter!==void 0?t.minFilter:pi}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;const n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new wo(5,5,5),r=new Ci({name:"CubemapFromEquirect",uniforms:Nr(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Ln,blending:hs});r.uniforms.tEquirect.value=t;const o=new Ai(s,r),a=t.minFilter;return t.minFilter===Ns&&(t.minFilter=pi),new wv(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t,n,s){const r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,n,s);e.setRenderTarget(r)}}const Fl=new H,Cv=new H,Rv=new Je;class as{constructor(e=new H(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){const s=Fl.subVectors(n,t).cross(Cv.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){const e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t){const n=e.delta(Fl),s=this.normal.dot(n);if(s===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;const r=-(e.start.dot(this.normal)+this.constant)/s;return r<0||r>1?null:t.copy(e.start).addScaledVector(n,r)}intersectsLine(e){const t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){const n=t||Rv.getNormalMatrix(e),s=this.coplanarPoint(Fl).applyMatrix4(e),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}}const Ts=new To,ta=new H;class Up{constructor(e=new as,t=new as,n=new as,s=new as,r=new as,o=new as){this.planes=[e,t,n,s,r,o]}set(e,t,n,s,r,o){const a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(n),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){const t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=Vi){const n=this.planes,s=e.elements,r=s[0],o=s[1],a=s[2],l=s[3],c=s[4],u=s[5],h=s[6],f=s[7],m=s[8],_=s[9],v=s[10],p=s[11],d=s[12],b=s[13],w=s[14],M=s[15];if(n[0].setComponents(l-r,f-c,p-m,M-d).normalize(),n[1].setComponents(l+r,f+c,p+m,M+d).normalize(),n[2].setComponents(l+o,f+u,p+_,M+b).normalize(),n[3].setComponents(l-o,f-u,p-_,M-b).normalize(),n[4].setComponents(l-a,f-h,p-v,M-w).normalize(),t===Vi)n[5].setComponents(l+a,f+h,p+v,M+w).normalize();else if(t===Ea)n[5].setComponents(a,h,v,w).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Ts.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{const t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Ts.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Ts)}intersectsSprite(e){return Ts.center.set(0,0,0),Ts.radius=.7071067811865476,Ts.applyMatrix4(e.matrixWorld),this.intersectsSphere(Ts)}intersectsSphere(e){const t=this.planes,n=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){const t=this.planes;for(let n=0;n<6;n++){const s=t[n];if(ta.x=s.normal.x>0?e.max.x:e.min.x,ta.y=s.normal.y>0?e.max.y:e.min.y,ta.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(ta)<0)return!1}return!0}containsPoint(e){const t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}}function Ip(){let i=null,e=!1,t=null,n=null;function s(r,o){t(r,o),n=i.requestAnimationFrame(s)}return{start:function(){e!==!0&&t!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){i=r}}}function Pv(i){const e=new WeakMap;function t(a,l){const c=a.array,u=a.usage,h=c.byteLength,f=i.createBuffer();i.bindBuffer(l,f),i.bufferData(l,c,u),a.onUploadCallback();let m;if(c instanceof Float32Array)m=i.FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?m=i.HALF_FLOAT:m=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)m=i.SHORT;else if(c instanceof Uint32Array)m=i.UNSIGNED_INT;else if(c instanceof Int32Array)m=i.INT;else if(c instanceof Int8Array)m=i.BYTE;else if(c instanceof Uint8Array)m=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)m=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:f,type:m,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:h}}function n(a,l,c){const u=l.array,h=l.updateRanges;if(i.bindBuffer(c,a),h.length===0)i.bufferSubData(c,0,u);else{h.sort((m,_)=>m.start-_.start);let f=0;for(let m=1;m<h.length;m++){const _=h[f],v=h[m];v.start<=_.start+_.count+1?_.count=Math.max(_.count,v.start+v.count-_.start):(++f,h[f]=v)}h.length=f+1;for(let m=0,_=h.length;m<_;m++){const v=h[m];i.bufferSubData(c,v.start*u.BYTES_PER_ELEMENT,u,v.start,v.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);const l=e.get(a);l&&(i.deleteBuffer(l.buffer),e.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){const u=e.get(a);(!u||u.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}const c=e.get(a);if(c===void 0)e.set(a,t(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}class Ao extends vn{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};const r=e/2,o=t/2,a=Math.floor(n),l=Math.floor(s),c=a+1,u=l+1,h=e/a,f=t/l,m=[],_=[],v=[],p=[];for(let d=0;d<u;d++){const b=d*f-o;for(let w=0;w<c;w++){const M=w*h-r;_.push(M,-b,0),v.push(0,0,1),p.push(w/a),p.push(1-d/l)}}for(let d=0;d<l;d++)for(let b=0;b<a;b++){const w=b+c*d,M=b+c*(d+1),B=b+1+c*(d+1),D=b+1+c*d;m.push(w,M,D),m.push(M,B,D)}this.setIndex(m),this.setAttribute("position",new fs(_,3)),this.setAttribute("normal",new fs(v,3)),this.setAttribute("uv",new fs(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new Ao(e.width,e.height,e.widthSegments,e.heightSegments)}}var Dv=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,Lv=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,Uv=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,Iv=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Nv=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,Fv=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,Ov=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,Bv=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,kv=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec3 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 ).rgb;
	}
#endif`,zv=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,Vv=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,Hv=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,Gv=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,Wv=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,Xv=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,Yv=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,qv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,jv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,Kv=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Zv=`#if defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#elif defined( USE_COLOR )
	diffuseColor.rgb *= vColor;
#endif`,$v=`#if defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#elif defined( USE_COLOR )
	varying vec3 vColor;
#endif`,Jv=`#if defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#elif defined( USE_COLOR ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec3 vColor;
#endif`,Qv=`#if defined( USE_COLOR_ALPHA )
	vColor = vec4( 1.0 );
#elif defined( USE_COLOR ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec3( 1.0 );
#endif
#ifdef USE_COLOR
	vColor *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.xyz *= instanceColor.xyz;
#endif
#ifdef USE_BATCHING_COLOR
	vec3 batchingColor = getBatchingColor( getIndirectIndex( gl_DrawID ) );
	vColor.xyz *= batchingColor.xyz;
#endif`,ex=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
vec3 inverseTransformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( vec4( dir, 0.0 ) * matrix ).xyz );
}
mat3 transposeMat3( const in mat3 m ) {
	mat3 tmp;
	tmp[ 0 ] = vec3( m[ 0 ].x, m[ 1 ].x, m[ 2 ].x );
	tmp[ 1 ] = vec3( m[ 0 ].y, m[ 1 ].y, m[ 2 ].y );
	tmp[ 2 ] = vec3( m[ 0 ].z, m[ 1 ].z, m[ 2 ].z );
	return tmp;
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,tx=`#ifdef ENVMAP_TYPE_CUBE_UV
	#define cubeUV_minMipLevel 4.0
	#define cubeUV_minTileSize 16.0
	float getFace( vec3 direction ) {
		vec3 absDirection = abs( direction );
		float face = - 1.0;
		if ( absDirection.x > absDirection.z ) {
			if ( absDirection.x > absDirection.y )
				face = direction.x > 0.0 ? 0.0 : 3.0;
			else
				face = direction.y > 0.0 ? 1.0 : 4.0;
		} else {
			if ( absDirection.z > absDirection.y )
				face = direction.z > 0.0 ? 2.0 : 5.0;
			else
				face = direction.y > 0.0 ? 1.0 : 4.0;
		}
		return face;
	}
	vec2 getUV( vec3 direction, float face ) {
		vec2 uv;
		if ( face == 0.0 ) {
			uv = vec2( direction.z, direction.y ) / abs( direction.x );
		} else if ( face == 1.0 ) {
			uv = vec2( - direction.x, - direction.z ) / abs( direction.y );
		} else if ( face == 2.0 ) {
			uv = vec2( - direction.x, direction.y ) / abs( direction.z );
		} else if ( face == 3.0 ) {
			uv = vec2( - direction.z, direction.y ) / abs( direction.x );
		} else if ( face == 4.0 ) {
			uv = vec2( - direction.x, direction.z ) / abs( direction.y );
		} else {
			uv = vec2( direction.x, direction.y ) / abs( direction.z );
		}
		return 0.5 * ( uv + 1.0 );
	}
	vec3 bilinearCubeUV( sampler2D envMap, vec3 direction, float mipInt ) {
		float face = getFace( direction );
		float filterInt = max( cubeUV_minMipLevel - mipInt, 0.0 );
		mipInt = max( mipInt, cubeUV_minMipLevel );
		float faceSize = exp2( mipInt );
		highp vec2 uv = getUV( direction, face ) * ( faceSize - 2.0 ) + 1.0;
		if ( face > 2.0 ) {
			uv.y += faceSize;
			face -= 3.0;
		}
		uv.x += face * faceSize;
		uv.x += filterInt * 3.0 * cubeUV_minTileSize;
		uv.y += 4.0 * ( exp2( CUBEUV_MAX_MIP ) - faceSize );
		uv.x *= CUBEUV_TEXEL_WIDTH;
		uv.y *= CUBEUV_TEXEL_HEIGHT;
		#ifdef texture2DGradEXT
			return texture2DGradEXT( envMap, uv, vec2( 0.0 ), vec2( 0.0 ) ).rgb;
		#else
			return texture2D( envMap, uv ).rgb;
		#endif
	}
	#define cubeUV_r0 1.0
	#define cubeUV_m0 - 2.0
	#define cubeUV_r1 0.8
	#define cubeUV_m1 - 1.0
	#define cubeUV_r4 0.4
	#define cubeUV_m4 2.0
	#define cubeUV_r5 0.305
	#define cubeUV_m5 3.0
	#define cubeUV_r6 0.21
	#define cubeUV_m6 4.0
	float roughnessToMip( float roughness ) {
		float mip = 0.0;
		if ( roughness >= cubeUV_r1 ) {
			mip = ( cubeUV_r0 - roughness ) * ( cubeUV_m1 - cubeUV_m0 ) / ( cubeUV_r0 - cubeUV_r1 ) + cubeUV_m0;
		} else if ( roughness >= cubeUV_r4 ) {
			mip = ( cubeUV_r1 - roughness ) * ( cubeUV_m4 - cubeUV_m1 ) / ( cubeUV_r1 - cubeUV_r4 ) + cubeUV_m1;
		} else if ( roughness >= cubeUV_r5 ) {
			mip = ( cubeUV_r4 - roughness ) * ( cubeUV_m5 - cubeUV_m4 ) / ( cubeUV_r4 - cubeUV_r5 ) + cubeUV_m4;
		} else if ( roughness >= cubeUV_r6 ) {
			mip = ( cubeUV_r5 - roughness ) * ( cubeUV_m6 - cubeUV_m5 ) / ( cubeUV_r5 - cubeUV_r6 ) + cubeUV_m5;
		} else {
			mip = - 2.0 * log2( 1.16 * roughness );		}
		return mip;
	}
	vec4 textureCubeUV( sampler2D envMap, vec3 sampleDir, float roughness ) {
		float mip = clamp( roughnessToMip( roughness ), cubeUV_m0, CUBEUV_MAX_MIP );
		float mipF = fract( mip );
		float mipInt = floor( mip );
		vec3 color0 = bilinearCubeUV( envMap, sampleDir, mipInt );
		if ( mipF == 0.0 ) {
			return vec4( color0, 1.0 );
		} else {
			vec3 color1 = bilinearCubeUV( envMap, sampleDir, mipInt + 1.0 );
			return vec4( mix( color0, color1, mipF ), 1.0 );
		}
	}
#endif`,nx=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
	#ifdef FLIP_SIDED
		transformedTangent = - transformedTangent;
	#endif
#endif`,ix=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,sx=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,rx=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,ox=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,ax="gl_FragColor = linearToOutputTexel( gl_FragColor );",lx=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,cx=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * vec3( flipEnvMap * reflectVec.x, reflectVec.yz ) );
	#else
		vec4 envColor = vec4( 0.0 );
	#endif
	#ifdef ENVMAP_BLENDING_MULTIPLY
		outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
	#elif defined( ENVMAP_BLENDING_MIX )
		outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
	#elif defined( ENVMAP_BLENDING_ADD )
		outgoingLight += envColor.xyz * specularStrength * reflectivity;
	#endif
#endif`,hx=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform float flipEnvMap;
	uniform mat3 envMapRotation;
	#ifdef ENVMAP_TYPE_CUBE
		uniform samplerCube envMap;
	#else
		uniform sampler2D envMap;
	#endif
	
#endif`,ux=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,fx=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,dx=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = inverseTransformDirection( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,px=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,mx=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,gx=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,_x=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,vx=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,xx=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Sx=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Mx=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,yx=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif`,Ex=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_CUBE_UV
			vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
			vec4 envMapColor = textureCubeUV( envMap, envMapRotation * worldNormal, 1.0 );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_CUBE_UV
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, roughness * roughness) );
			reflectVec = inverseTransformDirection( reflectVec, viewMatrix );
			vec4 envMapColor = textureCubeUV( envMap, envMapRotation * reflectVec, roughness );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_CUBE_UV
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
#endif`,bx=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Tx=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,wx=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Ax=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Cx=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb * ( 1.0 - metalnessFactor );
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.0525 );material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = mix( min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = mix( vec3( 0.04 ), diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.0525 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.07, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,Rx=`struct PhysicalMaterial {
	vec3 diffuseColor;
	float roughness;
	vec3 specularColor;
	float specularF90;
	float dispersion;
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		float v = 0.5 / ( gv + gl );
		return saturate(v);
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = material.clearcoatRoughness;
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColor;
	float f90 = material.specularF90;
	float roughness = material.roughness;
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float V = V_GGX_SmithCorrelated_Anisotropic( material.alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( material.alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transposeMat3( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float a = roughness < 0.25 ? -339.2 * r2 + 161.4 * roughness - 25.9 : -8.48 * r2 + 14.3 * roughness - 9.95;
	float b = roughness < 0.25 ? 44.0 * r2 - 23.7 * roughness + 3.26 : 1.97 * r2 - 3.27 * roughness + 0.72;
	float DG = exp( a * dotNV + b ) + ( roughness < 0.25 ? 0.0 : 0.1 * ( roughness - 0.25 ) );
	return saturate( DG * RECIPROCAL_PI );
}
vec2 DFGApprox( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	const vec4 c0 = vec4( - 1, - 0.0275, - 0.572, 0.022 );
	const vec4 c1 = vec4( 1, 0.0425, 1.04, - 0.04 );
	vec4 r = roughness * c0 + c1;
	float a004 = min( r.x * r.x, exp2( - 9.28 * dotNV ) ) * r.x + r.y;
	vec2 fab = vec2( - 1.04, 1.04 ) * a004 + r.zw;
	return fab;
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	vec2 fab = DFGApprox( normal, viewDir, roughness );
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, const in float roughness, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	vec2 fab = DFGApprox( normal, viewDir, roughness );
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColor * t2.x + ( vec3( 1.0 ) - material.specularColor ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseColor * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
	#endif
	reflectedLight.directSpecular += irradiance * BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
	#endif
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( geometryNormal, geometryViewDir, material.specularColor, material.specularF90, material.iridescence, material.iridescenceFresnel, material.roughness, singleScattering, multiScattering );
	#else
		computeMultiscattering( geometryNormal, geometryViewDir, material.specularColor, material.specularF90, material.roughness, singleScattering, multiScattering );
	#endif
	vec3 totalScattering = singleScattering + multiScattering;
	vec3 diffuse = material.diffuseColor * ( 1.0 - max( max( totalScattering.r, totalScattering.g ), totalScattering.b ) );
	reflectedLight.indirectSpecular += radiance * singleScattering;
	reflectedLight.indirectSpecular += multiScattering * cosineWeightedIrradiance;
	reflectedLight.indirectDiffuse += diffuse * cosineWeightedIrradiance;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,Px=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		material.iridescenceFresnel = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		material.iridescenceF0 = Schlick_to_F0( material.iridescenceFresnel, 1.0, dotNVi );
	}
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,Dx=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD ) && defined( ENVMAP_TYPE_CUBE_UV )
		iblIrradiance += getIBLIrradiance( geometryNormal );
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		radiance += getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		radiance += getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,Lx=`#if defined( RE_IndirectDiffuse )
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,Ux=`#if defined( USE_LOGDEPTHBUF )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,Ix=`#if defined( USE_LOGDEPTHBUF )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Nx=`#ifdef USE_LOGDEPTHBUF
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Fx=`#ifdef USE_LOGDEPTHBUF
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,Ox=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,Bx=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,kx=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,zx=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Vx=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,Hx=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,Gx=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,Wx=`#if defined( USE_MORPHCOLORS )
	vColor *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,Xx=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,Yx=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,qx=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,jx=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#if defined( DOUBLE_SIDED ) && ! defined( FLAT_SHADED )
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#if defined( DOUBLE_SIDED ) && ! defined( FLAT_SHADED )
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,Kx=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,Zx=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,$x=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,Jx=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
	#endif
#endif`,Qx=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,eS=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,tS=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,nS=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iS=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,sS=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,rS=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	return depth * ( near - far ) - near;
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	return ( near * far ) / ( ( far - near ) * depth - far );
}`,oS=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,aS=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,lS=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,cS=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,hS=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,uS=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,fS=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform sampler2D pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	float texture2DCompare( sampler2D depths, vec2 uv, float compare ) {
		return step( compare, unpackRGBAToDepth( texture2D( depths, uv ) ) );
	}
	vec2 texture2DDistribution( sampler2D shadow, vec2 uv ) {
		return unpackRGBATo2Half( texture2D( shadow, uv ) );
	}
	float VSMShadow (sampler2D shadow, vec2 uv, float compare ){
		float occlusion = 1.0;
		vec2 distribution = texture2DDistribution( shadow, uv );
		float hard_shadow = step( compare , distribution.x );
		if (hard_shadow != 1.0 ) {
			float distance = compare - distribution.x ;
			float variance = max( 0.00000, distribution.y * distribution.y );
			float softness_probability = variance / (variance + distance * distance );			softness_probability = clamp( ( softness_probability - 0.3 ) / ( 0.95 - 0.3 ), 0.0, 1.0 );			occlusion = clamp( max( hard_shadow, softness_probability ), 0.0, 1.0 );
		}
		return occlusion;
	}
	float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
		float shadow = 1.0;
		shadowCoord.xyz /= shadowCoord.w;
		shadowCoord.z += shadowBias;
		bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
		bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
		if ( frustumTest ) {
		#if defined( SHADOWMAP_TYPE_PCF )
			vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
			float dx0 = - texelSize.x * shadowRadius;
			float dy0 = - texelSize.y * shadowRadius;
			float dx1 = + texelSize.x * shadowRadius;
			float dy1 = + texelSize.y * shadowRadius;
			float dx2 = dx0 / 2.0;
			float dy2 = dy0 / 2.0;
			float dx3 = dx1 / 2.0;
			float dy3 = dy1 / 2.0;
			shadow = (
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy, shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, dy1 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy1 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, dy1 ), shadowCoord.z )
			) * ( 1.0 / 17.0 );
		#elif defined( SHADOWMAP_TYPE_PCF_SOFT )
			vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
			float dx = texelSize.x;
			float dy = texelSize.y;
			vec2 uv = shadowCoord.xy;
			vec2 f = fract( uv * shadowMapSize + 0.5 );
			uv -= f * texelSize;
			shadow = (
				texture2DCompare( shadowMap, uv, shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + vec2( dx, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + vec2( 0.0, dy ), shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + texelSize, shadowCoord.z ) +
				mix( texture2DCompare( shadowMap, uv + vec2( -dx, 0.0 ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, 0.0 ), shadowCoord.z ),
					 f.x ) +
				mix( texture2DCompare( shadowMap, uv + vec2( -dx, dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, dy ), shadowCoord.z ),
					 f.x ) +
				mix( texture2DCompare( shadowMap, uv + vec2( 0.0, -dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 0.0, 2.0 * dy ), shadowCoord.z ),
					 f.y ) +
				mix( texture2DCompare( shadowMap, uv + vec2( dx, -dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( dx, 2.0 * dy ), shadowCoord.z ),
					 f.y ) +
				mix( mix( texture2DCompare( shadowMap, uv + vec2( -dx, -dy ), shadowCoord.z ),
						  texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, -dy ), shadowCoord.z ),
						  f.x ),
					 mix( texture2DCompare( shadowMap, uv + vec2( -dx, 2.0 * dy ), shadowCoord.z ),
						  texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, 2.0 * dy ), shadowCoord.z ),
						  f.x ),
					 f.y )
			) * ( 1.0 / 9.0 );
		#elif defined( SHADOWMAP_TYPE_VSM )
			shadow = VSMShadow( shadowMap, shadowCoord.xy, shadowCoord.z );
		#else
			shadow = texture2DCompare( shadowMap, shadowCoord.xy, shadowCoord.z );
		#endif
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	vec2 cubeToUV( vec3 v, float texelSizeY ) {
		vec3 absV = abs( v );
		float scaleToCube = 1.0 / max( absV.x, max( absV.y, absV.z ) );
		absV *= scaleToCube;
		v *= scaleToCube * ( 1.0 - 2.0 * texelSizeY );
		vec2 planar = v.xy;
		float almostATexel = 1.5 * texelSizeY;
		float almostOne = 1.0 - almostATexel;
		if ( absV.z >= almostOne ) {
			if ( v.z > 0.0 )
				planar.x = 4.0 - v.x;
		} else if ( absV.x >= almostOne ) {
			float signX = sign( v.x );
			planar.x = v.z * signX + 2.0 * signX;
		} else if ( absV.y >= almostOne ) {
			float signY = sign( v.y );
			planar.x = v.x + 2.0 * signY + 2.0;
			planar.y = v.z * signY - 2.0;
		}
		return vec2( 0.125, 0.25 ) * planar + vec2( 0.375, 0.75 );
	}
	float getPointShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		
		float lightToPositionLength = length( lightToPosition );
		if ( lightToPositionLength - shadowCameraFar <= 0.0 && lightToPositionLength - shadowCameraNear >= 0.0 ) {
			float dp = ( lightToPositionLength - shadowCameraNear ) / ( shadowCameraFar - shadowCameraNear );			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			vec2 texelSize = vec2( 1.0 ) / ( shadowMapSize * vec2( 4.0, 2.0 ) );
			#if defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_PCF_SOFT ) || defined( SHADOWMAP_TYPE_VSM )
				vec2 offset = vec2( - 1, 1 ) * shadowRadius * texelSize.y;
				shadow = (
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xyy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yyy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xyx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yyx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xxy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yxy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xxx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yxx, texelSize.y ), dp )
				) * ( 1.0 / 9.0 );
			#else
				shadow = texture2DCompare( shadowMap, cubeToUV( bd3D, texelSize.y ), dp );
			#endif
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
#endif`,dS=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,pS=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	vec3 shadowWorldNormal = inverseTransformDirection( transformedNormal, viewMatrix );
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,mS=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,gS=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,_S=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,vS=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,xS=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,SS=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,MS=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,yS=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,ES=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,bS=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = inverseTransformDirection( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseColor, material.specularColor, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,TS=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
		
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
		
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		
		#else
		
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,wS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,AS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,CS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,RS=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`;const PS=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,DS=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,LS=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,US=`#ifdef ENVMAP_TYPE_CUBE
	uniform samplerCube envMap;
#elif defined( ENVMAP_TYPE_CUBE_UV )
	uniform sampler2D envMap;
#endif
uniform float flipEnvMap;
uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <cube_uv_reflection_fragment>
void main() {
	#ifdef ENVMAP_TYPE_CUBE
		vec4 texColor = textureCube( envMap, backgroundRotation * vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) );
	#elif defined( ENVMAP_TYPE_CUBE_UV )
		vec4 texColor = textureCubeUV( envMap, backgroundRotation * vWorldDirection, backgroundBlurriness );
	#else
		vec4 texColor = vec4( 0.0, 0.0, 0.0, 1.0 );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,IS=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,NS=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,FS=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,OS=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	float fragCoordZ = 0.5 * vHighPrecisionZW[0] / vHighPrecisionZW[1] + 0.5;
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,BS=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,kS=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main () {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = packDepthToRGBA( dist );
}`,zS=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,VS=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,HS=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,GS=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,WS=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,XS=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,YS=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,qS=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,jS=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,KS=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,ZS=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,$S=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <packing>
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( packNormalToRGB( normal ), diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,JS=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,QS=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,eM=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,tM=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <cube_uv_reflection_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
		float sheenEnergyComp = 1.0 - 0.157 * max3( material.sheenColor );
		outgoingLight = outgoingLight * sheenEnergyComp + sheenSpecularDirect + sheenSpecularIndirect;
	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,nM=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,iM=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,sM=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,rM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,oM=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,aM=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <packing>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,lM=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,cM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,et={alphahash_fragment:Dv,alphahash_pars_fragment:Lv,alphamap_fragment:Uv,alphamap_pars_fragment:Iv,alphatest_fragment:Nv,alphatest_pars_fragment:Fv,aomap_fragment:Ov,aomap_pars_fragment:Bv,batching_pars_vertex:kv,batching_vertex:zv,begin_vertex:Vv,beginnormal_vertex:Hv,bsdfs:Gv,iridescence_fragment:Wv,bumpmap_pars_fragment:Xv,clipping_planes_fragment:Yv,clipping_planes_pars_fragment:qv,clipping_planes_pars_vertex:jv,clipping_planes_vertex:Kv,color_fragment:Zv,color_pars_fragment:$v,color_pars_vertex:Jv,color_vertex:Qv,common:ex,cube_uv_reflection_fragment:tx,defaultnormal_vertex:nx,displacementmap_pars_vertex:ix,displacementmap_vertex:sx,emissivemap_fragment:rx,emissivemap_pars_fragment:ox,colorspace_fragment:ax,colorspace_pars_fragment:lx,envmap_fragment:cx,envmap_common_pars_fragment:hx,envmap_pars_fragment:ux,envmap_pars_vertex:fx,envmap_physical_pars_fragment:Ex,envmap_vertex:dx,fog_vertex:px,fog_pars_vertex:mx,fog_fragment:gx,fog_pars_fragment:_x,gradientmap_pars_fragment:vx,lightmap_pars_fragment:xx,lights_lambert_fragment:Sx,lights_lambert_pars_fragment:Mx,lights_pars_begin:yx,lights_toon_fragment:bx,lights_toon_pars_fragment:Tx,lights_phong_fragment:wx,lights_phong_pars_fragment:Ax,lights_physical_fragment:Cx,lights_physical_pars_fragment:Rx,lights_fragment_begin:Px,lights_fragment_maps:Dx,lights_fragment_end:Lx,logdepthbuf_fragment:Ux,logdepthbuf_pars_fragment:Ix,logdepthbuf_pars_vertex:Nx,logdepthbuf_vertex:Fx,map_fragment:Ox,map_pars_fragment:Bx,map_particle_fragment:kx,map_particle_pars_fragment:zx,metalnessmap_fragment:Vx,metalnessmap_pars_fragment:Hx,morphinstance_vertex:Gx,morphcolor_vertex:Wx,morphnormal_vertex:Xx,morphtarget_pars_vertex:Yx,morphtarget_vertex:qx,normal_fragment_begin:jx,normal_fragment_maps:Kx,normal_pars_fragment:Zx,normal_pars_vertex:$x,normal_vertex:Jx,normalmap_pars_fragment:Qx,clearcoat_normal_fragment_begin:eS,clearcoat_normal_fragment_maps:tS,clearcoat_pars_fragment:nS,iridescence_pars_fragment:iS,opaque_fragment:sS,packing:rS,premultiplied_alpha_fragment:oS,project_vertex:aS,dithering_fragment:lS,dithering_pars_fragment:cS,roughnessmap_fragment:hS,roughnessmap_pars_fragment:uS,shadowmap_pars_fragment:fS,shadowmap_pars_vertex:dS,shadowmap_vertex:pS,shadowmask_pars_fragment:mS,skinbase_vertex:gS,skinning_pars_vertex:_S,skinning_vertex:vS,skinnormal_vertex:xS,specularmap_fragment:SS,specularmap_pars_fragment:MS,tonemapping_fragment:yS,tonemapping_pars_fragment:ES,transmission_fragment:bS,transmission_pars_fragment:TS,uv_pars_fragment:wS,uv_pars_vertex:AS,uv_vertex:CS,worldpos_vertex:RS,background_vert:PS,background_frag:DS,backgroundCube_vert:LS,backgroundCube_frag:US,cube_vert:IS,cube_frag:NS,depth_vert:FS,depth_frag:OS,distanceRGBA_vert:BS,distanceRGBA_frag:kS,equirect_vert:zS,equirect_frag:VS,linedashed_vert:HS,linedashed_frag:GS,meshbasic_vert:WS,meshbasic_frag:XS,meshlambert_vert:YS,meshlambert_frag:qS,meshmatcap_vert:jS,meshmatcap_frag:KS,meshnormal_vert:ZS,meshnormal_frag:$S,meshphong_vert:JS,meshphong_frag:QS,meshphysical_vert:eM,meshphysical_frag:tM,meshtoon_vert:nM,meshtoon_frag:iM,points_vert:sM,points_frag:rM,shadow_vert:oM,shadow_frag:aM,sprite_vert:lM,sprite_frag:cM},be={common:{diffuse:{value:new xt(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new Je},alphaMap:{value:null},alphaMapTransform:{value:new Je},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new Je}},envmap:{envMap:{value:null},envMapRotation:{value:new Je},flipEnvMap:{value:-1},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new Je}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new Je}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new Je},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new Je},normalScale:{value:new nt(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new Je},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new Je}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new Je}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new Je}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new xt(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMap:{value:[]},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotShadowMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMap:{value:[]},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null}},points:{diffuse:{value:new xt(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new Je},alphaTest:{value:0},uvTransform:{value:new Je}},sprite:{diffuse:{value:new xt(16777215)},opacity:{value:1},center:{value:new nt(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new Je},alphaMap:{value:null},alphaMapTransform:{value:new Je},alphaTest:{value:0}}},Ti={basic:{uniforms:bn([be.common,be.specularmap,be.envmap,be.aomap,be.lightmap,be.fog]),vertexShader:et.meshbasic_vert,fragmentShader:et.meshbasic_frag},lambert:{uniforms:bn([be.common,be.specularmap,be.envmap,be.aomap,be.lightmap,be.emissivemap,be.bumpmap,be.normalmap,be.displacementmap,be.fog,be.lights,{emissive:{value:new xt(0)}}]),vertexShader:et.meshlambert_vert,fragmentShader:et.meshlambert_frag},phong:{uniforms:bn([be.common,be.specularmap,be.envmap,be.aomap,be.lightmap,be.emissivemap,be.bumpmap,be.normalmap,be.displacementmap,be.fog,be.lights,{emissive:{value:new xt(0)},specular:{value:new xt(1118481)},shininess:{value:30}}]),vertexShader:et.meshphong_vert,fragmentShader:et.meshphong_frag},standard:{uniforms:bn([be.common,be.envmap,be.aomap,be.lightmap,be.emissivemap,be.bumpmap,be.normalmap,be.displacementmap,be.roughnessmap,be.metalnessmap,be.fog,be.lights,{emissive:{value:new xt(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:et.meshphysical_vert,fragmentShader:et.meshphysical_frag},toon:{uniforms:bn([be.common,be.aomap,be.lightmap,be.emissivemap,be.bumpmap,be.normalmap,be.displacementmap,be.gradientmap,be.fog,be.lights,{emissive:{value:new xt(0)}}]),vertexShader:et.meshtoon_vert,fragmentShader:et.meshtoon_frag},matcap:{uniforms:bn([be.common,be.bumpmap,be.normalmap,be.displacementmap,be.fog,{matcap:{value:null}}]),vertexShader:et.meshmatcap_vert,fragmentShader:et.meshmatcap_frag},points:{uniforms:bn([be.points,be.fog]),vertexShader:et.points_vert,fragmentShader:et.points_frag},dashed:{uniforms:bn([be.common,be.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:et.linedashed_vert,fragmentShader:et.linedashed_frag},depth:{uniforms:bn([be.common,be.displacementmap]),vertexShader:et.depth_vert,fragmentShader:et.depth_frag},normal:{uniforms:bn([be.common,be.bumpmap,be.normalmap,be.displacementmap,{opacity:{value:1}}]),vertexShader:et.meshnormal_vert,fragmentShader:et.meshnormal_frag},sprite:{uniforms:bn([be.sprite,be.fog]),vertexShader:et.sprite_vert,fragmentShader:et.sprite_frag},background:{uniforms:{uvTransform:{value:new Je},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:et.background_vert,fragmentShader:et.background_frag},backgroundCube:{uniforms:{envMap:{value:null},flipEnvMap:{value:-1},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new Je}},vertexShader:et.backgroundCube_vert,fragmentShader:et.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:et.cube_vert,fragmentShader:et.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:et.equirect_vert,fragmentShader:et.equirect_frag},distanceRGBA:{uniforms:bn([be.common,be.displacementmap,{referencePosition:{value:new H},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:et.distanceRGBA_vert,fragmentShader:et.distanceRGBA_frag},shadow:{uniforms:bn([be.lights,be.fog,{color:{value:new xt(0)},opacity:{value:1}}]),vertexShader:et.shadow_vert,fragmentShader:et.shadow_frag}};Ti.physical={uniforms:bn([Ti.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new Je},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new Je},clearcoatNormalScale:{value:new nt(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new Je},dispersion:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new Je},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new Je},sheen:{value:0},sheenColor:{value:new xt(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new Je},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new Je},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new Je},transmissionSamplerSize:{value:new nt},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new Je},attenuationDistance:{value:0},attenuationColor:{value:new xt(0)},specularColor:{value:new xt(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new Je},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new Je},anisotropyVector:{value:new nt},anisotropyMap:{value:null},anisotropyMapTransform:{value:new Je}}]),vertexShader:et.meshphysical_vert,fragmentShader:et.meshphysical_frag};const na={r:0,b:0,g:0},ws=new qi,hM=new Nt;function uM(i,e,t,n,s,r,o){const a=new xt(0);let l=r===!0?0:1,c,u,h=null,f=0,m=null;function _(b){let w=b.isScene===!0?b.background:null;return w&&w.isTexture&&(w=(b.backgroundBlurriness>0?t:e).get(w)),w}function v(b){let w=!1;const M=_(b);M===null?d(a,l):M&&M.isColor&&(d(M,1),w=!0);const B=i.xr.getEnvironmentBlendMode();B==="additive"?n.buffers.color.setClear(0,0,0,1,o):B==="alpha-blend"&&n.buffers.color.setClear(0,0,0,0,o),(i.autoClear||w)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function p(b,w){const M=_(w);M&&(M.isCubeTexture||M.mapping===za)?(u===void 0&&(u=new Ai(new wo(1,1,1),new Ci({name:"BackgroundCubeMaterial",uniforms:Nr(Ti.backgroundCube.uniforms),vertexShader:Ti.backgroundCube.vertexShader,fragmentShader:Ti.backgroundCube.fragmentShader,side:Ln,depthTest:!1,depthWrite:!1,fog:!1})),u.geometry.deleteAttribute("normal"),u.geometry.deleteAttribute("uv"),u.onBeforeRender=function(B,D,L){this.matrixWorld.copyPosition(L.matrixWorld)},Object.defineProperty(u.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),s.update(u)),ws.copy(w.backgroundRotation),ws.x*=-1,ws.y*=-1,ws.z*=-1,M.isCubeTexture&&M.isRenderTargetTexture===!1&&(ws.y*=-1,ws.z*=-1),u.material.uniforms.envMap.value=M,u.material.uniforms.flipEnvMap.value=M.isCubeTexture&&M.isRenderTargetTexture===!1?-1:1,u.material.uniforms.backgroundBlurriness.value=w.backgroundBlurriness,u.material.uniforms.backgroundIntensity.value=w.backgroundIntensity,u.material.uniforms.backgroundRotation.value.setFromMatrix4(hM.makeRotationFromEuler(ws)),u.material.toneMapped=ft.getTransfer(M.colorSpace)!==Tt,(h!==M||f!==M.version||m!==i.toneMapping)&&(u.material.needsUpdate=!0,h=M,f=M.version,m=i.toneMapping),u.layers.enableAll(),b.unshift(u,u.geometry,u.material,0,0,null)):M&&M.isTexture&&(c===void 0&&(c=new Ai(new Ao(2,2),new Ci({name:"BackgroundMaterial",uniforms:Nr(Ti.background.uniforms),vertexShader:Ti.background.vertexShader,fragmentShader:Ti.background.fragmentShader,side:ps,depthTest:!1,depthWrite:!1,fog:!1})),c.geometry.deleteAttribute("normal"),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),s.update(c)),c.material.uniforms.t2D.value=M,c.material.uniforms.backgroundIntensity.value=w.backgroundIntensity,c.material.toneMapped=ft.getTransfer(M.colorSpace)!==Tt,M.matrixAutoUpdate===!0&&M.updateMatrix(),c.material.uniforms.uvTransform.value.copy(M.matrix),(h!==M||f!==M.version||m!==i.toneMapping)&&(c.material.needsUpdate=!0,h=M,f=M.version,m=i.toneMapping),c.layers.enableAll(),b.unshift(c,c.geometry,c.material,0,0,null))}function d(b,w){b.getRGB(na,Pp(i)),n.buffers.color.setClear(na.r,na.g,na.b,w,o)}return{getClearColor:function(){return a},setClearColor:function(b,w=1){a.set(b),l=w,d(a,l)},getClearAlpha:function(){return l},setClearAlpha:function(b){l=b,d(a,l)},render:v,addToRenderList:p}}function fM(i,e){const t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=f(null);let r=s,o=!1;function a(y,R,K,F,G){let Z=!1;const j=h(F,K,R);r!==j&&(r=j,c(r.object)),Z=m(y,F,K,G),Z&&_(y,F,K,G),G!==null&&e.update(G,i.ELEMENT_ARRAY_BUFFER),(Z||o)&&(o=!1,M(y,R,K,F),G!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(G).buffer))}function l(){return i.createVertexArray()}function c(y){return i.bindVertexArray(y)}function u(y){return i.deleteVertexArray(y)}function h(y,R,K){const F=K.wireframe===!0;let G=n[y.id];G===void 0&&(G={},n[y.id]=G);let Z=G[R.id];Z===void 0&&(Z={},G[R.id]=Z);let j=Z[F];return j===void 0&&(j=f(l()),Z[F]=j),j}function f(y){const R=[],K=[],F=[];for(let G=0;G<t;G++)R[G]=0,K[G]=0,F[G]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:R,enabledAttributes:K,attributeDivisors:F,object:y,attributes:{},index:null}}function m(y,R,K,F){const G=r.attributes,Z=R.attributes;let j=0;const ee=K.getAttributes();for(const Q in ee)if(ee[Q].location>=0){const ce=G[Q];let me=Z[Q];if(me===void 0&&(Q==="instanceMatrix"&&y.instanceMatrix&&(me=y.instanceMatrix),Q==="instanceColor"&&y.instanceColor&&(me=y.instanceColor)),ce===void 0||ce.attribute!==me||me&&ce.data!==me.data)return!0;j++}return r.attributesNum!==j||r.index!==F}function _(y,R,K,F){const G={},Z=R.attributes;let j=0;const ee=K.getAttributes();for(const Q in ee)if(ee[Q].location>=0){let ce=Z[Q];ce===void 0&&(Q==="instanceMatrix"&&y.instanceMatrix&&(ce=y.instanceMatrix),Q==="instanceColor"&&y.instanceColor&&(ce=y.instanceColor));const me={};me.attribute=ce,ce&&ce.data&&(me.data=ce.data),G[Q]=me,j++}r.attributes=G,r.attributesNum=j,r.index=F}function v(){const y=r.newAttributes;for(let R=0,K=y.length;R<K;R++)y[R]=0}function p(y){d(y,0)}function d(y,R){const K=r.newAttributes,F=r.enabledAttributes,G=r.attributeDivisors;K[y]=1,F[y]===0&&(i.enableVertexAttribArray(y),F[y]=1),G[y]!==R&&(i.vertexAttribDivisor(y,R),G[y]=R)}function b(){const y=r.newAttributes,R=r.enabledAttributes;for(let K=0,F=R.length;K<F;K++)R[K]!==y[K]&&(i.disableVertexAttribArray(K),R[K]=0)}function w(y,R,K,F,G,Z,j){j===!0?i.vertexAttribIPointer(y,R,K,G,Z):i.vertexAttribPointer(y,R,K,F,G,Z)}function M(y,R,K,F){v();const G=F.attributes,Z=K.getAttributes(),j=R.defaultAttributeValues;for(const ee in Z){const Q=Z[ee];if(Q.location>=0){let ue=G[ee];if(ue===void 0&&(ee==="instanceMatrix"&&y.instanceMatrix&&(ue=y.instanceMatrix),ee==="instanceColor"&&y.instanceColor&&(ue=y.instanceColor)),ue!==void 0){const ce=ue.normalized,me=ue.itemSize,Se=e.get(ue);if(Se===void 0)continue;const pe=Se.buffer,ie=Se.type,ae=Se.bytesPerElement,ge=ie===i.INT||ie===i.UNSIGNED_INT||ue.gpuType===gh;if(ue.isInterleavedBufferAttribute){const oe=ue.data,ke=oe.stride,Ve=ue.offset;if(oe.isInstancedInterleavedBuffer){for(let Ie=0;Ie<Q.locationSize;Ie++)d(Q.location+Ie,oe.meshPerAttribute);y.isInstancedMesh!==!0&&F._maxInstanceCount===void 0&&(F._maxInstanceCount=oe.meshPerAttribute*oe.count)}else for(let Ie=0;Ie<Q.locationSize;Ie++)p(Q.location+Ie);i.bindBuffer(i.ARRAY_BUFFER,pe);for(let Ie=0;Ie<Q.locationSize;Ie++)w(Q.location+Ie,me/Q.locationSize,ie,ce,ke*ae,(Ve+me/Q.locationSize*Ie)*ae,ge)}else{if(ue.isInstancedBufferAttribute){for(let oe=0;oe<Q.locationSize;oe++)d(Q.location+oe,ue.meshPerAttribute);y.isInstancedMesh!==!0&&F._maxInstanceCount===void 0&&(F._maxInstanceCount=ue.meshPerAttribute*ue.count)}else for(let oe=0;oe<Q.locationSize;oe++)p(Q.location+oe);i.bindBuffer(i.ARRAY_BUFFER,pe);for(let oe=0;oe<Q.locationSize;oe++)w(Q.location+oe,me/Q.locationSize,ie,ce,me*ae,me/Q.locationSize*oe*ae,ge)}}else if(j!==void 0){const ce=j[ee];if(ce!==void 0)switch(ce.length){case 2:i.vertexAttrib2fv(Q.location,ce);break;case 3:i.vertexAttrib3fv(Q.location,ce);break;case 4:i.vertexAttrib4fv(Q.location,ce);break;default:i.vertexAttrib1fv(Q.location,ce)}}}}b()}function B(){U();for(const y in n){const R=n[y];for(const K in R){const F=R[K];for(const G in F)u(F[G].object),delete F[G];delete R[K]}delete n[y]}}function D(y){if(n[y.id]===void 0)return;const R=n[y.id];for(const K in R){const F=R[K];for(const G in F)u(F[G].object),delete F[G];delete R[K]}delete n[y.id]}function L(y){for(const R in n){const K=n[R];if(K[y.id]===void 0)continue;const F=K[y.id];for(const G in F)u(F[G].object),delete F[G];delete K[y.id]}}function U(){T(),o=!0,r!==s&&(r=s,c(r.object))}function T(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:U,resetDefaultState:T,dispose:B,releaseStatesOfGeometry:D,releaseStatesOfProgram:L,initAttributes:v,enableAttribute:p,disableUnusedAttributes:b}}function dM(i,e,t){let n;function s(c){n=c}function r(c,u){i.drawArrays(n,c,u),t.update(u,n,1)}function o(c,u,h){h!==0&&(i.drawArraysInstanced(n,c,u,h),t.update(u,n,h))}function a(c,u,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,c,0,u,0,h);let m=0;for(let _=0;_<h;_++)m+=u[_];t.update(m,n,1)}function l(c,u,h,f){if(h===0)return;const m=e.get("WEBGL_multi_draw");if(m===null)for(let _=0;_<c.length;_++)o(c[_],u[_],f[_]);else{m.multiDrawArraysInstancedWEBGL(n,c,0,u,0,f,0,h);let _=0;for(let v=0;v<h;v++)_+=u[v]*f[v];t.update(_,n,1)}}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a,this.renderMultiDrawInstances=l}function pM(i,e,t,n){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){const L=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(L.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(L){return!(L!==mi&&n.convert(L)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(L){const U=L===Eo&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(L!==Yi&&n.convert(L)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE)&&L!==zi&&!U)}function l(L){if(L==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";L="mediump"}return L==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp";const u=l(c);u!==c&&(console.warn("THREE.WebGLRenderer:",c,"not supported, using",u,"instead."),c=u);const h=t.logarithmicDepthBuffer===!0,f=t.reverseDepthBuffer===!0&&e.has("EXT_clip_control"),m=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),_=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),v=i.getParameter(i.MAX_TEXTURE_SIZE),p=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),d=i.getParameter(i.MAX_VERTEX_ATTRIBS),b=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),w=i.getParameter(i.MAX_VARYING_VECTORS),M=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),B=_>0,D=i.getParameter(i.MAX_SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:h,reverseDepthBuffer:f,maxTextures:m,maxVertexTextures:_,maxTextureSize:v,maxCubemapSize:p,maxAttributes:d,maxVertexUniforms:b,maxVaryings:w,maxFragmentUniforms:M,vertexTextures:B,maxSamples:D}}function mM(i){const e=this;let t=null,n=0,s=!1,r=!1;const o=new as,a=new Je,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(h,f){const m=h.length!==0||f||n!==0||s;return s=f,n=h.length,m},this.beginShadows=function(){r=!0,u(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(h,f){t=u(h,f,0)},this.setState=function(h,f,m){const _=h.clippingPlanes,v=h.clipIntersection,p=h.clipShadows,d=i.get(h);if(!s||_===null||_.length===0||r&&!p)r?u(null):c();else{const b=r?0:n,w=b*4;let M=d.clippingState||null;l.value=M,M=u(_,f,w,m);for(let B=0;B!==w;++B)M[B]=t[B];d.clippingState=M,this.numIntersection=v?this.numPlanes:0,this.numPlanes+=b}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function u(h,f,m,_){const v=h!==null?h.length:0;let p=null;if(v!==0){if(p=l.value,_!==!0||p===null){const d=m+v*4,b=f.matrixWorldInverse;a.getNormalMatrix(b),(p===null||p.length<d)&&(p=new Float32Array(d));for(let w=0,M=m;w!==v;++w,M+=4)o.copy(h[w]).applyMatrix4(b,a),o.normal.toArray(p,M),p[M+3]=o.constant}l.value=p,l.needsUpdate=!0}return e.numPlanes=v,e.numIntersection=0,p}}function gM(i){let e=new WeakMap;function t(o,a){return a===_c?o.mapping=Dr:a===vc&&(o.mapping=Lr),o}function n(o){if(o&&o.isTexture){const a=o.mapping;if(a===_c||a===vc)if(e.has(o)){const l=e.get(o).texture;return t(l,o.mapping)}else{const l=o.image;if(l&&l.height>0){const c=new Av(l.height);return c.fromEquirectangularTexture(i,o),e.set(o,c),o.addEventListener("dispose",s),t(c.texture,o.mapping)}else return null}}return o}function s(o){const a=o.target;a.removeEventListener("dispose",s);const l=e.get(a);l!==void 0&&(e.delete(a),l.dispose())}function r(){e=new WeakMap}return{get:n,dispose:r}}class _M extends Dp{constructor(e=-1,t=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){const e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2;let r=n-e,o=n+e,a=s+t,l=s-t;if(this.view!==null&&this.view.enabled){const c=(this.right-this.left)/this.view.fullWidth/this.zoom,u=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=u*this.view.offsetY,l=a-u*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){const t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}}const xr=4,Sf=[.125,.215,.35,.446,.526,.582],Us=20,Ol=new _M,Mf=new xt;let Bl=null,kl=0,zl=0,Vl=!1;const Ps=(1+Math.sqrt(5))/2,gr=1/Ps,yf=[new H(-Ps,gr,0),new H(Ps,gr,0),new H(-gr,0,Ps),new H(gr,0,Ps),new H(0,Ps,-gr),new H(0,Ps,gr),new H(-1,1,-1),new H(1,1,-1),new H(-1,1,1),new H(1,1,1)];class Ef{constructor(e){this._renderer=e,this._pingPongRenderTarget=null,this._lodMax=0,this._cubeSize=0,this._lodPlanes=[],this._sizeLods=[],this._sigmas=[],this._blurMaterial=null,this._cubemapMaterial=null,this._equirectMaterial=null,this._compileMaterial(this._blurMaterial)}fromScene(e,t=0,n=.1,s=100){Bl=this._renderer.getRenderTarget(),kl=this._renderer.getActiveCubeFace(),zl=this._renderer.getActiveMipmapLevel(),Vl=this._renderer.xr.enabled,this._renderer.xr.enabled=!1,this._setSize(256);const r=this._allocateTargets();return r.depthBuffer=!0,this._sceneToCubeUV(e,n,s,r),t>0&&this._blur(r,0,0,t),this._applyPMREM(r),this._cleanup(r),r}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=wf(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Tf(),this._compileMaterial(this._equirectMaterial))}dispose(){this._dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose()}_setSize(e){this._lodMax=Math.floor(Math.log2(e)),this._cubeSize=Math.pow(2,this._lodMax)}_dispose(){this._blurMaterial!==null&&this._blurMaterial.dispose(),this._pingPongRenderTarget!==null&&this._pingPongRenderTarget.dispose();for(let e=0;e<this._lodPlanes.length;e++)this._lodPlanes[e].dispose()}_cleanup(e){this._renderer.setRenderTarget(Bl,kl,zl),this._renderer.xr.enabled=Vl,e.scissorTest=!1,ia(e,0,0,e.width,e.height)}_fromTexture(e,t){e.mapping===Dr||e.mapping===Lr?this._setSize(e.image.length===0?16:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4),Bl=this._renderer.getRenderTarget(),kl=this._renderer.getActiveCubeFace(),zl=this._renderer.getActiveMipmapLevel(),Vl=this._renderer.xr.enabled,this._renderer.xr.enabled=!1;const n=t||this._allocateTargets();return this._textureToCubeUV(e,n),this._applyPMREM(n),this._cleanup(n),n}_allocateTargets(){const e=3*Math.max(this._cubeSize,112),t=4*this._cubeSize,n={magFilter:pi,minFilter:pi,generateMipmaps:!1,type:Eo,format:mi,colorSpace:zr,depthBuffer:!1},s=bf(e,t,n);if(this._pingPongRenderTarget===null||this._pingPongRenderTarget.width!==e||this._pingPongRenderTarget.height!==t){this._pingPongRenderTarget!==null&&this._dispose(),this._pingPongRenderTarget=bf(e,t,n);const{_lodMax:r}=this;({sizeLods:this._sizeLods,lodPlanes:this._lodPlanes,sigmas:this._sigmas}=vM(r)),this._blurMaterial=xM(r,e,t)}return s}_compileMaterial(e){const t=new Ai(this._lodPlanes[0],e);this._renderer.compile(t,Ol)}_sceneToCubeUV(e,t,n,s){const a=new ei(90,1,t,n),l=[1,-1,1,1,1,1],c=[1,1,1,-1,-1,-1],u=this._renderer,h=u.autoClear,f=u.toneMapping;u.getClearColor(Mf),u.toneMapping=us,u.autoClear=!1;const m=new Ap({name:"PMREM.Background",side:Ln,depthWrite:!1,depthTest:!1}),_=new Ai(new wo,m);let v=!1;const p=e.background;p?p.isColor&&(m.color.copy(p),e.background=null,v=!0):(m.color.copy(Mf),v=!0);for(let d=0;d<6;d++){const b=d%3;b===0?(a.up.set(0,l[d],0),a.lookAt(c[d],0,0)):b===1?(a.up.set(0,0,l[d]),a.lookAt(0,c[d],0)):(a.up.set(0,l[d],0),a.lookAt(0,0,c[d]));const w=this._cubeSize;ia(s,b*w,d>2?w:0,w,w),u.setRenderTarget(s),v&&u.render(_,a),u.render(e,a)}_.geometry.dispose(),_.material.dispose(),u.toneMapping=f,u.autoClear=h,e.background=p}_textureToCubeUV(e,t){const n=this._renderer,s=e.mapping===Dr||e.mapping===Lr;s?(this._cubemapMaterial===null&&(this._cubemapMaterial=wf()),this._cubemapMaterial.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):this._equirectMaterial===null&&(this._equirectMaterial=Tf());const r=s?this._cubemapMaterial:this._equirectMaterial,o=new Ai(this._lodPlanes[0],r),a=r.uniforms;a.envMap.value=e;const l=this._cubeSize;ia(t,0,0,3*l,2*l),n.setRenderTarget(t),n.render(o,Ol)}_applyPMREM(e){const t=this._renderer,n=t.autoClear;t.autoClear=!1;const s=this._lodPlanes.length;for(let r=1;r<s;r++){const o=Math.sqrt(this._sigmas[r]*this._sigmas[r]-this._sigmas[r-1]*this._sigmas[r-1]),a=yf[(s-r-1)%yf.length];this._blur(e,r-1,r,o,a)}t.autoClear=n}_blur(e,t,n,s,r){const o=this._pingPongRenderTarget;this._halfBlur(e,o,t,n,s,"latitudinal",r),this._halfBlur(o,e,n,n,s,"longitudinal",r)}_halfBlur(e,t,n,s,r,o,a){const l=this._renderer,c=this._blurMaterial;o!=="latitudinal"&&o!=="longitudinal"&&console.error("blur direction must be either latitudinal or longitudinal!");const u=3,h=new Ai(this._lodPlanes[s],c),f=c.uniforms,m=this._sizeLods[n]-1,_=isFinite(r)?Math.PI/(2*m):2*Math.PI/(2*Us-1),v=r/_,p=isFinite(r)?1+Math.floor(u*v):Us;p>Us&&console.warn(`sigmaRadians, ${r}, is too large and will clip, as it requested ${p} samples when the maximum is set to ${Us}`);const d=[];let b=0;for(let L=0;L<Us;++L){const U=L/v,T=Math.exp(-U*U/2);d.push(T),L===0?b+=T:L<p&&(b+=2*T)}for(let L=0;L<d.length;L++)d[L]=d[L]/b;f.envMap.value=e.texture,f.samples.value=p,f.weights.value=d,f.latitudinal.value=o==="latitudinal",a&&(f.poleAxis.value=a);const{_lodMax:w}=this;f.dTheta.value=_,f.mipInt.value=w-n;const M=this._sizeLods[s],B=3*M*(s>w-xr?s-w+xr:0),D=4*(this._cubeSize-M);ia(t,B,D,3*M,2*M),l.setRenderTarget(t),l.render(h,Ol)}}function vM(i){const e=[],t=[],n=[];let s=i;const r=i-xr+1+Sf.length;for(let o=0;o<r;o++){const a=Math.pow(2,s);t.push(a);let l=1/a;o>i-xr?l=Sf[o-i+xr-1]:o===0&&(l=0),n.push(l);const c=1/(a-2),u=-c,h=1+c,f=[u,u,h,u,h,h,u,u,h,h,u,h],m=6,_=6,v=3,p=2,d=1,b=new Float32Array(v*_*m),w=new Float32Array(p*_*m),M=new Float32Array(d*_*m);for(let D=0;D<m;D++){const L=D%3*2/3-1,U=D>2?0:-1,T=[L,U,0,L+2/3,U,0,L+2/3,U+1,0,L,U,0,L+2/3,U+1,0,L,U+1,0];b.set(T,v*_*D),w.set(f,p*_*D);const y=[D,D,D,D,D,D];M.set(y,d*_*D)}const B=new vn;B.setAttribute("position",new Cn(b,v)),B.setAttribute("uv",new Cn(w,p)),B.setAttribute("faceIndex",new Cn(M,d)),e.push(B),s>xr&&s--}return{lodPlanes:e,sizeLods:t,sigmas:n}}function bf(i,e,t){const n=new ks(i,e,t);return n.texture.mapping=za,n.texture.name="PMREM.cubeUv",n.scissorTest=!0,n}function ia(i,e,t,n,s){i.viewport.set(e,t,n,s),i.scissor.set(e,t,n,s)}function xM(i,e,t){const n=new Float32Array(Us),s=new H(0,1,0);return new Ci({name:"SphericalGaussianBlur",defines:{n:Us,CUBEUV_TEXEL_WIDTH:1/e,CUBEUV_TEXEL_HEIGHT:1/t,CUBEUV_MAX_MIP:`${i}.0`},uniforms:{envMap:{value:null},samples:{value:1},weights:{value:n},latitudinal:{value:!1},dTheta:{value:0},mipInt:{value:0},poleAxis:{value:s}},vertexShader:Eh(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			varying vec3 vOutputDirection;

			uniform sampler2D envMap;
			uniform int samples;
			uniform float weights[ n ];
			uniform bool latitudinal;
			uniform float dTheta;
			uniform float mipInt;
			uniform vec3 poleAxis;

			#define ENVMAP_TYPE_CUBE_UV
			#include <cube_uv_reflection_fragment>

			vec3 getSample( float theta, vec3 axis ) {

				float cosTheta = cos( theta );
				// Rodrigues' axis-angle rotation
				vec3 sampleDirection = vOutputDirection * cosTheta
					+ cross( axis, vOutputDirection ) * sin( theta )
					+ axis * dot( axis, vOutputDirection ) * ( 1.0 - cosTheta );

				return bilinearCubeUV( envMap, sampleDirection, mipInt );

			}

			void main() {

				vec3 axis = latitudinal ? poleAxis : cross( poleAxis, vOutputDirection );

				if ( all( equal( axis, vec3( 0.0 ) ) ) ) {

					axis = vec3( vOutputDirection.z, 0.0, - vOutputDirection.x );

				}

				axis = normalize( axis );

				gl_FragColor = vec4( 0.0, 0.0, 0.0, 1.0 );
				gl_FragColor.rgb += weights[ 0 ] * getSample( 0.0, axis );

				for ( int i = 1; i < n; i++ ) {

					if ( i >= samples ) {

						break;

					}

					float theta = dTheta * float( i );
					gl_FragColor.rgb += weights[ i ] * getSample( -1.0 * theta, axis );
					gl_FragColor.rgb += weights[ i ] * getSample( theta, axis );

				}

			}
		`,blending:hs,depthTest:!1,depthWrite:!1})}function Tf(){return new Ci({name:"EquirectangularToCubeUV",uniforms:{envMap:{value:null}},vertexShader:Eh(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			varying vec3 vOutputDirection;

			uniform sampler2D envMap;

			#include <common>

			void main() {

				vec3 outputDirection = normalize( vOutputDirection );
				vec2 uv = equirectUv( outputDirection );

				gl_FragColor = vec4( texture2D ( envMap, uv ).rgb, 1.0 );

			}
		`,blending:hs,depthTest:!1,depthWrite:!1})}function wf(){return new Ci({name:"CubemapToCubeUV",uniforms:{envMap:{value:null},flipEnvMap:{value:-1}},vertexShader:Eh(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			uniform float flipEnvMap;

			varying vec3 vOutputDirection;

			uniform samplerCube envMap;

			void main() {

				gl_FragColor = textureCube( envMap, vec3( flipEnvMap * vOutputDirection.x, vOutputDirection.yz ) );

			}
		`,blending:hs,depthTest:!1,depthWrite:!1})}function Eh(){return`

		precision mediump float;
		precision mediump int;

		attribute float faceIndex;

		varying vec3 vOutputDirection;

		// RH coordinate system; PMREM face-indexing convention
		vec3 getDirection( vec2 uv, float face ) {

			uv = 2.0 * uv - 1.0;

			vec3 direction = vec3( uv, 1.0 );

			if ( face == 0.0 ) {

				direction = direction.zyx; // ( 1, v, u ) pos x

			} else if ( face == 1.0 ) {

				direction = direction.xzy;
				direction.xz *= -1.0; // ( -u, 1, -v ) pos y

			} else if ( face == 2.0 ) {

				direction.x *= -1.0; // ( -u, v, 1 ) pos z

			} else if ( face == 3.0 ) {

				direction = direction.zyx;
				direction.xz *= -1.0; // ( -1, v, -u ) neg x

			} else if ( face == 4.0 ) {

				direction = direction.xzy;
				direction.xy *= -1.0; // ( -u, -1, v ) neg y

			} else if ( face == 5.0 ) {

				direction.z *= -1.0; // ( u, v, -1 ) neg z

			}

			return direction;

		}

		void main() {

			vOutputDirection = getDirection( uv, faceIndex );
			gl_Position = vec4( position, 1.0 );

		}
	`}function SM(i){let e=new WeakMap,t=null;function n(a){if(a&&a.isTexture){const l=a.mapping,c=l===_c||l===vc,u=l===Dr||l===Lr;if(c||u){let h=e.get(a);const f=h!==void 0?h.texture.pmremVersion:0;if(a.isRenderTargetTexture&&a.pmremVersion!==f)return t===null&&(t=new Ef(i)),h=c?t.fromEquirectangular(a,h):t.fromCubemap(a,h),h.texture.pmremVersion=a.pmremVersion,e.set(a,h),h.texture;if(h!==void 0)return h.texture;{const m=a.image;return c&&m&&m.height>0||u&&m&&s(m)?(t===null&&(t=new Ef(i)),h=c?t.fromEquirectangular(a):t.fromCubemap(a),h.texture.pmremVersion=a.pmremVersion,e.set(a,h),a.addEventListener("dispose",r),h.texture):null}}}return a}function s(a){let l=0;const c=6;for(let u=0;u<c;u++)a[u]!==void 0&&l++;return l===c}function r(a){const l=a.target;l.removeEventListener("dispose",r);const c=e.get(l);c!==void 0&&(e.delete(l),c.dispose())}function o(){e=new WeakMap,t!==null&&(t.dispose(),t=null)}return{get:n,dispose:o}}function MM(i){const e={};function t(n){if(e[n]!==void 0)return e[n];let s;switch(n){case"WEBGL_depth_texture":s=i.getExtension("WEBGL_depth_texture")||i.getExtension("MOZ_WEBGL_depth_texture")||i.getExtension("WEBKIT_WEBGL_depth_texture");break;case"EXT_texture_filter_anisotropic":s=i.getExtension("EXT_texture_filter_anisotropic")||i.getExtension("MOZ_EXT_texture_filter_anisotropic")||i.getExtension("WEBKIT_EXT_texture_filter_anisotropic");break;case"WEBGL_compressed_texture_s3tc":s=i.getExtension("WEBGL_compressed_texture_s3tc")||i.getExtension("MOZ_WEBGL_compressed_texture_s3tc")||i.getExtension("WEBKIT_WEBGL_compressed_texture_s3tc");break;case"WEBGL_compressed_texture_pvrtc":s=i.getExtension("WEBGL_compressed_texture_pvrtc")||i.getExtension("WEBKIT_WEBGL_compressed_texture_pvrtc");break;default:s=i.getExtension(n)}return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){const s=t(n);return s===null&&lo("THREE.WebGLRenderer: "+n+" extension not supported."),s}}}function yM(i,e,t,n){const s={},r=new WeakMap;function o(h){const f=h.target;f.index!==null&&e.remove(f.index);for(const _ in f.attributes)e.remove(f.attributes[_]);for(const _ in f.morphAttributes){const v=f.morphAttributes[_];for(let p=0,d=v.length;p<d;p++)e.remove(v[p])}f.removeEventListener("dispose",o),delete s[f.id];const m=r.get(f);m&&(e.remove(m),r.delete(f)),n.releaseStatesOfGeometry(f),f.isInstancedBufferGeometry===!0&&delete f._maxInstanceCount,t.memory.geometries--}function a(h,f){return s[f.id]===!0||(f.addEventListener("dispose",o),s[f.id]=!0,t.memory.geometries++),f}function l(h){const f=h.attributes;for(const _ in f)e.update(f[_],i.ARRAY_BUFFER);const m=h.morphAttributes;for(const _ in m){const v=m[_];for(let p=0,d=v.length;p<d;p++)e.update(v[p],i.ARRAY_BUFFER)}}function c(h){const f=[],m=h.index,_=h.attributes.position;let v=0;if(m!==null){const b=m.array;v=m.version;for(let w=0,M=b.length;w<M;w+=3){const B=b[w+0],D=b[w+1],L=b[w+2];f.push(B,D,D,L,L,B)}}else if(_!==void 0){const b=_.array;v=_.version;for(let w=0,M=b.length/3-1;w<M;w+=3){const B=w+0,D=w+1,L=w+2;f.push(B,D,D,L,L,B)}}else return;const p=new(yp(f)?Rp:Cp)(f,1);p.version=v;const d=r.get(h);d&&e.remove(d),r.set(h,p)}function u(h){const f=r.get(h);if(f){const m=h.index;m!==null&&f.version<m.version&&c(h)}else c(h);return r.get(h)}return{get:a,update:l,getWireframeAttribute:u}}function EM(i,e,t){let n;function s(f){n=f}let r,o;function a(f){r=f.type,o=f.bytesPerElement}function l(f,m){i.drawElements(n,m,r,f*o),t.update(m,n,1)}function c(f,m,_){_!==0&&(i.drawElementsInstanced(n,m,r,f*o,_),t.update(m,n,_))}function u(f,m,_){if(_===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,m,0,r,f,0,_);let p=0;for(let d=0;d<_;d++)p+=m[d];t.update(p,n,1)}function h(f,m,_,v){if(_===0)return;const p=e.get("WEBGL_multi_draw");if(p===null)for(let d=0;d<f.length;d++)c(f[d]/o,m[d],v[d]);else{p.multiDrawElementsInstancedWEBGL(n,m,0,r,f,0,v,0,_);let d=0;for(let b=0;b<_;b++)d+=m[b]*v[b];t.update(d,n,1)}}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=u,this.renderMultiDrawInstances=h}function bM(i){const e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,a){switch(t.calls++,o){case i.TRIANGLES:t.triangles+=a*(r/3);break;case i.LINES:t.lines+=a*(r/2);break;case i.LINE_STRIP:t.lines+=a*(r-1);break;case i.LINE_LOOP:t.lines+=a*r;break;case i.POINTS:t.points+=a*r;break;default:console.error("THREE.WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function TM(i,e,t){const n=new WeakMap,s=new Gt;function r(o,a,l){const c=o.morphTargetInfluences,u=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,h=u!==void 0?u.length:0;let f=n.get(a);if(f===void 0||f.count!==h){let T=function(){L.dispose(),n.delete(a),a.removeEventListener("dispose",T)};f!==void 0&&f.texture.dispose();const m=a.morphAttributes.position!==void 0,_=a.morphAttributes.normal!==void 0,v=a.morphAttributes.color!==void 0,p=a.morphAttributes.position||[],d=a.morphAttributes.normal||[],b=a.morphAttributes.color||[];let w=0;m===!0&&(w=1),_===!0&&(w=2),v===!0&&(w=3);let M=a.attributes.position.count*w,B=1;M>e.maxTextureSize&&(B=Math.ceil(M/e.maxTextureSize),M=e.maxTextureSize);const D=new Float32Array(M*B*4*h),L=new bp(D,M,B,h);L.type=zi,L.needsUpdate=!0;const U=w*4;for(let y=0;y<h;y++){const R=p[y],K=d[y],F=b[y],G=M*B*4*y;for(let Z=0;Z<R.count;Z++){const j=Z*U;m===!0&&(s.fromBufferAttribute(R,Z),D[G+j+0]=s.x,D[G+j+1]=s.y,D[G+j+2]=s.z,D[G+j+3]=0),_===!0&&(s.fromBufferAttribute(K,Z),D[G+j+4]=s.x,D[G+j+5]=s.y,D[G+j+6]=s.z,D[G+j+7]=0),v===!0&&(s.fromBufferAttribute(F,Z),D[G+j+8]=s.x,D[G+j+9]=s.y,D[G+j+10]=s.z,D[G+j+11]=F.itemSize===4?s.w:1)}}f={count:h,texture:L,size:new nt(M,B)},n.set(a,f),a.addEventListener("dispose",T)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",o.morphTexture,t);else{let m=0;for(let v=0;v<c.length;v++)m+=c[v];const _=a.morphTargetsRelative?1:1-m;l.getUniforms().setValue(i,"morphTargetBaseInfluence",_),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",f.texture,t),l.getUniforms().setValue(i,"morphTargetsTextureSize",f.size)}return{update:r}}function wM(i,e,t,n){let s=new WeakMap;function r(l){const c=n.render.frame,u=l.geometry,h=e.get(l,u);if(s.get(h)!==c&&(e.update(h),s.set(h,c)),l.isInstancedMesh&&(l.hasEventListener("dispose",a)===!1&&l.addEventListener("dispose",a),s.get(l)!==c&&(t.update(l.instanceMatrix,i.ARRAY_BUFFER),l.instanceColor!==null&&t.update(l.instanceColor,i.ARRAY_BUFFER),s.set(l,c))),l.isSkinnedMesh){const f=l.skeleton;s.get(f)!==c&&(f.update(),s.set(f,c))}return h}function o(){s=new WeakMap}function a(l){const c=l.target;c.removeEventListener("dispose",a),t.remove(c.instanceMatrix),c.instanceColor!==null&&t.remove(c.instanceColor)}return{update:r,dispose:o}}class Np extends wn{constructor(e,t,n,s,r,o,a,l,c,u=Er){if(u!==Er&&u!==Ir)throw new Error("DepthTexture format must be either THREE.DepthFormat or THREE.DepthStencilFormat");n===void 0&&u===Er&&(n=Bs),n===void 0&&u===Ir&&(n=Ur),super(null,s,r,o,a,l,u,n,c),this.isDepthTexture=!0,this.image={width:e,height:t},this.magFilter=a!==void 0?a:Xn,this.minFilter=l!==void 0?l:Xn,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.compareFunction=e.compareFunction,this}toJSON(e){const t=super.toJSON(e);return this.compareFunction!==null&&(t.compareFunction=this.compareFunction),t}}const Fp=new wn,Af=new Np(1,1),Op=new bp,Bp=new uv,kp=new Lp,Cf=[],Rf=[],Pf=new Float32Array(16),Df=new Float32Array(9),Lf=new Float32Array(4);function Hr(i,e,t){const n=i[0];if(n<=0||n>0)return i;const s=e*t;let r=Cf[s];if(r===void 0&&(r=new Float32Array(s),Cf[s]=r),e!==0){n.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,i[o].toArray(r,a)}return r}function Qt(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function en(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function Ga(i,e){let t=Rf[e];t===void 0&&(t=new Int32Array(e),Rf[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function AM(i,e){const t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function CM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Qt(t,e))return;i.uniform2fv(this.addr,e),en(t,e)}}function RM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(Qt(t,e))return;i.uniform3fv(this.addr,e),en(t,e)}}function PM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Qt(t,e))return;i.uniform4fv(this.addr,e),en(t,e)}}function DM(i,e){const t=this.cache,n=e.elements;if(n===void 0){if(Qt(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),en(t,e)}else{if(Qt(t,n))return;Lf.set(n),i.uniformMatrix2fv(this.addr,!1,Lf),en(t,n)}}function LM(i,e){const t=this.cache,n=e.elements;if(n===void 0){if(Qt(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),en(t,e)}else{if(Qt(t,n))return;Df.set(n),i.uniformMatrix3fv(this.addr,!1,Df),en(t,n)}}function UM(i,e){const t=this.cache,n=e.elements;if(n===void 0){if(Qt(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),en(t,e)}else{if(Qt(t,n))return;Pf.set(n),i.uniformMatrix4fv(this.addr,!1,Pf),en(t,n)}}function IM(i,e){const t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function NM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Qt(t,e))return;i.uniform2iv(this.addr,e),en(t,e)}}function FM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Qt(t,e))return;i.uniform3iv(this.addr,e),en(t,e)}}function OM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Qt(t,e))return;i.uniform4iv(this.addr,e),en(t,e)}}function BM(i,e){const t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function kM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Qt(t,e))return;i.uniform2uiv(this.addr,e),en(t,e)}}function zM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Qt(t,e))return;i.uniform3uiv(this.addr,e),en(t,e)}}function VM(i,e){const t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Qt(t,e))return;i.uniform4uiv(this.addr,e),en(t,e)}}function HM(i,e,t){const n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?(Af.compareFunction=Mp,r=Af):r=Fp,t.setTexture2D(e||r,s)}function GM(i,e,t){const n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||Bp,s)}function WM(i,e,t){const n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTextureCube(e||kp,s)}function XM(i,e,t){const n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||Op,s)}function YM(i){switch(i){case 5126:return AM;case 35664:return CM;case 35665:return RM;case 35666:return PM;case 35674:return DM;case 35675:return LM;case 35676:return UM;case 5124:case 35670:return IM;case 35667:case 35671:return NM;case 35668:case 35672:return FM;case 35669:case 35673:return OM;case 5125:return BM;case 36294:return kM;case 36295:return zM;case 36296:return VM;case 35678:case 36198:case 36298:case 36306:case 35682:return HM;case 35679:case 36299:case 36307:return GM;case 35680:case 36300:case 36308:case 36293:return WM;case 36289:case 36303:case 36311:case 36292:return XM}}function qM(i,e){i.uniform1fv(this.addr,e)}function jM(i,e){const t=Hr(e,this.size,2);i.uniform2fv(this.addr,t)}function KM(i,e){const t=Hr(e,this.size,3);i.uniform3fv(this.addr,t)}function ZM(i,e){const t=Hr(e,this.size,4);i.uniform4fv(this.addr,t)}function $M(i,e){const t=Hr(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function JM(i,e){const t=Hr(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function QM(i,e){const t=Hr(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function ey(i,e){i.uniform1iv(this.addr,e)}function ty(i,e){i.uniform2iv(this.addr,e)}function ny(i,e){i.uniform3iv(this.addr,e)}function iy(i,e){i.uniform4iv(this.addr,e)}function sy(i,e){i.uniform1uiv(this.addr,e)}function ry(i,e){i.uniform2uiv(this.addr,e)}function oy(i,e){i.uniform3uiv(this.addr,e)}function ay(i,e){i.uniform4uiv(this.addr,e)}function ly(i,e,t){const n=this.cache,s=e.length,r=Ga(t,s);Qt(n,r)||(i.uniform1iv(this.addr,r),en(n,r));for(let o=0;o!==s;++o)t.setTexture2D(e[o]||Fp,r[o])}function cy(i,e,t){const n=this.cache,s=e.length,r=Ga(t,s);Qt(n,r)||(i.uniform1iv(this.addr,r),en(n,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||Bp,r[o])}function hy(i,e,t){const n=this.cache,s=e.length,r=Ga(t,s);Qt(n,r)||(i.uniform1iv(this.addr,r),en(n,r));for(let o=0;o!==s;++o)t.setTextureCube(e[o]||kp,r[o])}function uy(i,e,t){const n=this.cache,s=e.length,r=Ga(t,s);Qt(n,r)||(i.uniform1iv(this.addr,r),en(n,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||Op,r[o])}function fy(i){switch(i){case 5126:return qM;case 35664:return jM;case 35665:return KM;case 35666:return ZM;case 35674:return $M;case 35675:return JM;case 35676:return QM;case 5124:case 35670:return ey;case 35667:case 35671:return ty;case 35668:case 35672:return ny;case 35669:case 35673:return iy;case 5125:return sy;case 36294:return ry;case 36295:return oy;case 36296:return ay;case 35678:case 36198:case 36298:case 36306:case 35682:return ly;case 35679:case 36299:case 36307:return cy;case 35680:case 36300:case 36308:case 36293:return hy;case 36289:case 36303:case 36311:case 36292:return uy}}class dy{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=YM(t.type)}}class py{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=fy(t.type)}}class my{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){const s=this.seq;for(let r=0,o=s.length;r!==o;++r){const a=s[r];a.setValue(e,t[a.id],n)}}}const Hl=/(\w+)(\])?(\[|\.)?/g;function Uf(i,e){i.seq.push(e),i.map[e.id]=e}function gy(i,e,t){const n=i.name,s=n.length;for(Hl.lastIndex=0;;){const r=Hl.exec(n),o=Hl.lastIndex;let a=r[1];const l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){Uf(t,c===void 0?new dy(a,i,e):new py(a,i,e));break}else{let h=t.map[a];h===void 0&&(h=new my(a),Uf(t,h)),t=h}}}class _a{constructor(e,t){this.seq=[],this.map={};const n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let s=0;s<n;++s){const r=e.getActiveUniform(t,s),o=e.getUniformLocation(t,r.name);gy(r,o,this)}}setValue(e,t,n,s){const r=this.map[t];r!==void 0&&r.setValue(e,n,s)}setOptional(e,t,n){const s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let r=0,o=t.length;r!==o;++r){const a=t[r],l=n[a.id];l.needsUpdate!==!1&&a.setValue(e,l.value,s)}}static seqWithValue(e,t){const n=[];for(let s=0,r=e.length;s!==r;++s){const o=e[s];o.id in t&&n.push(o)}return n}}function If(i,e,t){const n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}const _y=37297;let vy=0;function xy(i,e){const t=i.split(`
`),n=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){const a=o+1;n.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return n.join(`
`)}const Nf=new Je;function Sy(i){ft._getMatrix(Nf,ft.workingColorSpace,i);const e=`mat3( ${Nf.elements.map(t=>t.toFixed(4))} )`;switch(ft.getTransfer(i)){case Va:return[e,"LinearTransferOETF"];case Tt:return[e,"sRGBTransferOETF"];default:return console.warn("THREE.WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function Ff(i,e,t){const n=i.getShaderParameter(e,i.COMPILE_STATUS),s=i.getShaderInfoLog(e).trim();if(n&&s==="")return"";const r=/ERROR: 0:(\d+)/.exec(s);if(r){const o=parseInt(r[1]);return t.toUpperCase()+`

`+s+`

`+xy(i.getShaderSource(e),o)}else return s}function My(i,e){const t=Sy(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( value.rgb * ${t[0]}, value.a ) );`,"}"].join(`
`)}function yy(i,e){let t;switch(e){case y0:t="Linear";break;case E0:t="Reinhard";break;case b0:t="Cineon";break;case T0:t="ACESFilmic";break;case A0:t="AgX";break;case C0:t="Neutral";break;case w0:t="Custom";break;default:console.warn("THREE.WebGLProgram: Unsupported toneMapping:",e),t="Linear"}return"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}const sa=new H;function Ey(){ft.getLuminanceCoefficients(sa);const i=sa.x.toFixed(4),e=sa.y.toFixed(4),t=sa.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function by(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(co).join(`
`)}function Ty(i){const e=[];for(const t in i){const n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function wy(i,e){const t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){const r=i.getActiveAttrib(e,s),o=r.name;let a=1;r.type===i.FLOAT_MAT2&&(a=2),r.type===i.FLOAT_MAT3&&(a=3),r.type===i.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:i.getAttribLocation(e,o),locationSize:a}}return t}function co(i){return i!==""}function Of(i,e){const t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows)}function Bf(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}const Ay=/^[ \t]*#include +<([\w\d./]+)>/gm;function Zc(i){return i.replace(Ay,Ry)}const Cy=new Map;function Ry(i,e){let t=et[e];if(t===void 0){const n=Cy.get(e);if(n!==void 0)t=et[n],console.warn('THREE.WebGLRenderer: Shader chunk "%s" has been deprecated. Use "%s" instead.',e,n);else throw new Error("Can not resolve #include <"+e+">")}return Zc(t)}const Py=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function kf(i){return i.replace(Py,Dy)}function Dy(i,e,t,n){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function zf(i){let e=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?e+=`
#define HIGH_PRECISION`:i.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}function Ly(i){let e="SHADOWMAP_TYPE_BASIC";return i.shadowMapType===lp?e="SHADOWMAP_TYPE_PCF":i.shadowMapType===t0?e="SHADOWMAP_TYPE_PCF_SOFT":i.shadowMapType===Bi&&(e="SHADOWMAP_TYPE_VSM"),e}function Uy(i){let e="ENVMAP_TYPE_CUBE";if(i.envMap)switch(i.envMapMode){case Dr:case Lr:e="ENVMAP_TYPE_CUBE";break;case za:e="ENVMAP_TYPE_CUBE_UV";break}return e}function Iy(i){let e="ENVMAP_MODE_REFLECTION";if(i.envMap)switch(i.envMapMode){case Lr:e="ENVMAP_MODE_REFRACTION";break}return e}function Ny(i){let e="ENVMAP_BLENDING_NONE";if(i.envMap)switch(i.combine){case cp:e="ENVMAP_BLENDING_MULTIPLY";break;case S0:e="ENVMAP_BLENDING_MIX";break;case M0:e="ENVMAP_BLENDING_ADD";break}return e}function Fy(i){const e=i.envMapCubeUVHeight;if(e===null)return null;const t=Math.log2(e)-2,n=1/e;return{texelWidth:1/(3*Math.max(Math.pow(2,t),7*16)),texelHeight:n,maxMip:t}}function Oy(i,e,t,n){const s=i.getContext(),r=t.defines;let o=t.vertexShader,a=t.fragmentShader;const l=Ly(t),c=Uy(t),u=Iy(t),h=Ny(t),f=Fy(t),m=by(t),_=Ty(r),v=s.createProgram();let p,d,b=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,_].filter(co).join(`
`),p.length>0&&(p+=`
`),d=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,_].filter(co).join(`
`),d.length>0&&(d+=`
`)):(p=[zf(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,_,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+u:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGDEPTHBUF":"",t.reverseDepthBuffer?"#define USE_REVERSEDEPTHBUF":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(co).join(`
`),d=[zf(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,_,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+u:"",t.envMap?"#define "+h:"",f?"#define CUBEUV_TEXEL_WIDTH "+f.texelWidth:"",f?"#define CUBEUV_TEXEL_HEIGHT "+f.texelHeight:"",f?"#define CUBEUV_MAX_MIP "+f.maxMip+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor||t.batchingColor?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGDEPTHBUF":"",t.reverseDepthBuffer?"#define USE_REVERSEDEPTHBUF":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==us?"#define TONE_MAPPING":"",t.toneMapping!==us?et.tonemapping_pars_fragment:"",t.toneMapping!==us?yy("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",et.colorspace_pars_fragment,My("linearToOutputTexel",t.outputColorSpace),Ey(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(co).join(`
`)),o=Zc(o),o=Of(o,t),o=Bf(o,t),a=Zc(a),a=Of(a,t),a=Bf(a,t),o=kf(o),a=kf(a),t.isRawShaderMaterial!==!0&&(b=`#version 300 es
`,p=[m,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+p,d=["#define varying in",t.glslVersion===$u?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===$u?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+d);const w=b+p+o,M=b+d+a,B=If(s,s.VERTEX_SHADER,w),D=If(s,s.FRAGMENT_SHADER,M);s.attachShader(v,B),s.attachShader(v,D),t.index0AttributeName!==void 0?s.bindAttribLocation(v,0,t.index0AttributeName):t.morphTargets===!0&&s.bindAttribLocation(v,0,"position"),s.linkProgram(v);function L(R){if(i.debug.checkShaderErrors){const K=s.getProgramInfoLog(v).trim(),F=s.getShaderInfoLog(B).trim(),G=s.getShaderInfoLog(D).trim();let Z=!0,j=!0;if(s.getProgramParameter(v,s.LINK_STATUS)===!1)if(Z=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,v,B,D);else{const ee=Ff(s,B,"vertex"),Q=Ff(s,D,"fragment");console.error("THREE.WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(v,s.VALIDATE_STATUS)+`

Material Name: `+R.name+`
Material Type: `+R.type+`

Program Info Log: `+K+`
`+ee+`
`+Q)}else K!==""?console.warn("THREE.WebGLProgram: Program Info Log:",K):(F===""||G==="")&&(j=!1);j&&(R.diagnostics={runnable:Z,programLog:K,vertexShader:{log:F,prefix:p},fragmentShader:{log:G,prefix:d}})}s.deleteShader(B),s.deleteShader(D),U=new _a(s,v),T=wy(s,v)}let U;this.getUniforms=function(){return U===void 0&&L(this),U};let T;this.getAttributes=function(){return T===void 0&&L(this),T};let y=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return y===!1&&(y=s.getProgramParameter(v,_y)),y},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(v),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=vy++,this.cacheKey=e,this.usedTimes=1,this.program=v,this.vertexShader=B,this.fragmentShader=D,this}let By=0;class ky{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e){const t=e.vertexShader,n=e.fragmentShader,s=this._getShaderStage(t),r=this._getShaderStage(n),o=this._getShaderCacheForMaterial(e);return o.has(s)===!1&&(o.add(s),s.usedTimes++),o.has(r)===!1&&(o.add(r),r.usedTimes++),this}remove(e){const t=this.materialCache.get(e);for(const n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderID(e){return this._getShaderStage(e.vertexShader).id}getFragmentShaderID(e){return this._getShaderStage(e.fragmentShader).id}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){const t=this.materialCache;let n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){const t=this.shaderCache;let n=t.get(e);return n===void 0&&(n=new zy(e),t.set(e,n)),n}}class zy{constructor(e){this.id=By++,this.code=e,this.usedTimes=0}}function Vy(i,e,t,n,s,r,o){const a=new Tp,l=new ky,c=new Set,u=[],h=s.logarithmicDepthBuffer,f=s.vertexTextures;let m=s.precision;const _={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distanceRGBA",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function v(T){return c.add(T),T===0?"uv":`uv${T}`}function p(T,y,R,K,F){const G=K.fog,Z=F.geometry,j=T.isMeshStandardMaterial?K.environment:null,ee=(T.isMeshStandardMaterial?t:e).get(T.envMap||j),Q=ee&&ee.mapping===za?ee.image.height:null,ue=_[T.type];T.precision!==null&&(m=s.getMaxPrecision(T.precision),m!==T.precision&&console.warn("THREE.WebGLProgram.getParameters:",T.precision,"not supported, using",m,"instead."));const ce=Z.morphAttributes.position||Z.morphAttributes.normal||Z.morphAttributes.color,me=ce!==void 0?ce.length:0;let Se=0;Z.morphAttributes.position!==void 0&&(Se=1),Z.morphAttributes.normal!==void 0&&(Se=2),Z.morphAttributes.color!==void 0&&(Se=3);let pe,ie,ae,ge;if(ue){const gt=Ti[ue];pe=gt.vertexShader,ie=gt.fragmentShader}else pe=T.vertexShader,ie=T.fragmentShader,l.update(T),ae=l.getVertexShaderID(T),ge=l.getFragmentShaderID(T);const oe=i.getRenderTarget(),ke=i.state.buffers.depth.getReversed(),Ve=F.isInstancedMesh===!0,Ie=F.isBatchedMesh===!0,ot=!!T.map,Ke=!!T.matcap,at=!!ee,k=!!T.aoMap,jt=!!T.lightMap,$e=!!T.bumpMap,Qe=!!T.normalMap,He=!!T.displacementMap,ct=!!T.emissiveMap,Pe=!!T.metalnessMap,C=!!T.roughnessMap,S=T.anisotropy>0,q=T.clearcoat>0,J=T.dispersion>0,V=T.iridescence>0,te=T.sheen>0,Me=T.transmission>0,_e=S&&!!T.anisotropyMap,Te=q&&!!T.clearcoatMap,je=q&&!!T.clearcoatNormalMap,fe=q&&!!T.clearcoatRoughnessMap,ve=V&&!!T.iridescenceMap,Ne=V&&!!T.iridescenceThicknessMap,Oe=te&&!!T.sheenColorMap,Ee=te&&!!T.sheenRoughnessMap,tt=!!T.specularMap,Ye=!!T.specularColorMap,ht=!!T.specularIntensityMap,O=Me&&!!T.transmissionMap,xe=Me&&!!T.thicknessMap,ne=!!T.gradientMap,re=!!T.alphaMap,we=T.alphaTest>0,Ae=!!T.alphaHash,Ze=!!T.extensions;let Ft=us;T.toneMapped&&(oe===null||oe.isXRRenderTarget===!0)&&(Ft=i.toneMapping);const nn={shaderID:ue,shaderType:T.type,shaderName:T.name,vertexShader:pe,fragmentShader:ie,defines:T.defines,customVertexShaderID:ae,customFragmentShaderID:ge,isRawShaderMaterial:T.isRawShaderMaterial===!0,glslVersion:T.glslVersion,precision:m,batching:Ie,batchingColor:Ie&&F._colorsTexture!==null,instancing:Ve,instancingColor:Ve&&F.instanceColor!==null,instancingMorph:Ve&&F.morphTexture!==null,supportsVertexTextures:f,outputColorSpace:oe===null?i.outputColorSpace:oe.isXRRenderTarget===!0?oe.texture.colorSpace:zr,alphaToCoverage:!!T.alphaToCoverage,map:ot,matcap:Ke,envMap:at,envMapMode:at&&ee.mapping,envMapCubeUVHeight:Q,aoMap:k,lightMap:jt,bumpMap:$e,normalMap:Qe,displacementMap:f&&He,emissiveMap:ct,normalMapObjectSpace:Qe&&T.normalMapType===U0,normalMapTangentSpace:Qe&&T.normalMapType===L0,metalnessMap:Pe,roughnessMap:C,anisotropy:S,anisotropyMap:_e,clearcoat:q,clearcoatMap:Te,clearcoatNormalMap:je,clearcoatRoughnessMap:fe,dispersion:J,iridescence:V,iridescenceMap:ve,iridescenceThicknessMap:Ne,sheen:te,sheenColorMap:Oe,sheenRoughnessMap:Ee,specularMap:tt,specularColorMap:Ye,specularIntensityMap:ht,transmission:Me,transmissionMap:O,thicknessMap:xe,gradientMap:ne,opaque:T.transparent===!1&&T.blending===yr&&T.alphaToCoverage===!1,alphaMap:re,alphaTest:we,alphaHash:Ae,combine:T.combine,mapUv:ot&&v(T.map.channel),aoMapUv:k&&v(T.aoMap.channel),lightMapUv:jt&&v(T.lightMap.channel),bumpMapUv:$e&&v(T.bumpMap.channel),normalMapUv:Qe&&v(T.normalMap.channel),displacementMapUv:He&&v(T.displacementMap.channel),emissiveMapUv:ct&&v(T.emissiveMap.channel),metalnessMapUv:Pe&&v(T.metalnessMap.channel),roughnessMapUv:C&&v(T.roughnessMap.channel),anisotropyMapUv:_e&&v(T.anisotropyMap.channel),clearcoatMapUv:Te&&v(T.clearcoatMap.channel),clearcoatNormalMapUv:je&&v(T.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:fe&&v(T.clearcoatRoughnessMap.channel),iridescenceMapUv:ve&&v(T.iridescenceMap.channel),iridescenceThicknessMapUv:Ne&&v(T.iridescenceThicknessMap.channel),sheenColorMapUv:Oe&&v(T.sheenColorMap.channel),sheenRoughnessMapUv:Ee&&v(T.sheenRoughnessMap.channel),specularMapUv:tt&&v(T.specularMap.channel),specularColorMapUv:Ye&&v(T.specularColorMap.channel),specularIntensityMapUv:ht&&v(T.specularIntensityMap.channel),transmissionMapUv:O&&v(T.transmissionMap.channel),thicknessMapUv:xe&&v(T.thicknessMap.channel),alphaMapUv:re&&v(T.alphaMap.channel),vertexTangents:!!Z.attributes.tangent&&(Qe||S),vertexColors:T.vertexColors,vertexAlphas:T.vertexColors===!0&&!!Z.attributes.color&&Z.attributes.color.itemSize===4,pointsUvs:F.isPoints===!0&&!!Z.attributes.uv&&(ot||re),fog:!!G,useFog:T.fog===!0,fogExp2:!!G&&G.isFogExp2,flatShading:T.flatShading===!0,sizeAttenuation:T.sizeAttenuation===!0,logarithmicDepthBuffer:h,reverseDepthBuffer:ke,skinning:F.isSkinnedMesh===!0,morphTargets:Z.morphAttributes.position!==void 0,morphNormals:Z.morphAttributes.normal!==void 0,morphColors:Z.morphAttributes.color!==void 0,morphTargetsCount:me,morphTextureStride:Se,numDirLights:y.directional.length,numPointLights:y.point.length,numSpotLights:y.spot.length,numSpotLightMaps:y.spotLightMap.length,numRectAreaLights:y.rectArea.length,numHemiLights:y.hemi.length,numDirLightShadows:y.directionalShadowMap.length,numPointLightShadows:y.pointShadowMap.length,numSpotLightShadows:y.spotShadowMap.length,numSpotLightShadowsWithMaps:y.numSpotLightShadowsWithMaps,numLightProbes:y.numLightProbes,numClippingPlanes:o.numPlanes,numClipIntersection:o.numIntersection,dithering:T.dithering,shadowMapEnabled:i.shadowMap.enabled&&R.length>0,shadowMapType:i.shadowMap.type,toneMapping:Ft,decodeVideoTexture:ot&&T.map.isVideoTexture===!0&&ft.getTransfer(T.map.colorSpace)===Tt,decodeVideoTextureEmissive:ct&&T.emissiveMap.isVideoTexture===!0&&ft.getTransfer(T.emissiveMap.colorSpace)===Tt,premultipliedAlpha:T.premultipliedAlpha,doubleSided:T.side===ki,flipSided:T.side===Ln,useDepthPacking:T.depthPacking>=0,depthPacking:T.depthPacking||0,index0AttributeName:T.index0AttributeName,extensionClipCullDistance:Ze&&T.extensions.clipCullDistance===!0&&n.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Ze&&T.extensions.multiDraw===!0||Ie)&&n.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:n.has("KHR_parallel_shader_compile"),customProgramCacheKey:T.customProgramCacheKey()};return nn.vertexUv1s=c.has(1),nn.vertexUv2s=c.has(2),nn.vertexUv3s=c.has(3),c.clear(),nn}function d(T){const y=[];if(T.shaderID?y.push(T.shaderID):(y.push(T.customVertexShaderID),y.push(T.customFragmentShaderID)),T.defines!==void 0)for(const R in T.defines)y.push(R),y.push(T.defines[R]);return T.isRawShaderMaterial===!1&&(b(y,T),w(y,T),y.push(i.outputColorSpace)),y.push(T.customProgramCacheKey),y.join()}function b(T,y){T.push(y.precision),T.push(y.outputColorSpace),T.push(y.envMapMode),T.push(y.envMapCubeUVHeight),T.push(y.mapUv),T.push(y.alphaMapUv),T.push(y.lightMapUv),T.push(y.aoMapUv),T.push(y.bumpMapUv),T.push(y.normalMapUv),T.push(y.displacementMapUv),T.push(y.emissiveMapUv),T.push(y.metalnessMapUv),T.push(y.roughnessMapUv),T.push(y.anisotropyMapUv),T.push(y.clearcoatMapUv),T.push(y.clearcoatNormalMapUv),T.push(y.clearcoatRoughnessMapUv),T.push(y.iridescenceMapUv),T.push(y.iridescenceThicknessMapUv),T.push(y.sheenColorMapUv),T.push(y.sheenRoughnessMapUv),T.push(y.specularMapUv),T.push(y.specularColorMapUv),T.push(y.specularIntensityMapUv),T.push(y.transmissionMapUv),T.push(y.thicknessMapUv),T.push(y.combine),T.push(y.fogExp2),T.push(y.sizeAttenuation),T.push(y.morphTargetsCount),T.push(y.morphAttributeCount),T.push(y.numDirLights),T.push(y.numPointLights),T.push(y.numSpotLights),T.push(y.numSpotLightMaps),T.push(y.numHemiLights),T.push(y.numRectAreaLights),T.push(y.numDirLightShadows),T.push(y.numPointLightShadows),T.push(y.numSpotLightShadows),T.push(y.numSpotLightShadowsWithMaps),T.push(y.numLightProbes),T.push(y.shadowMapType),T.push(y.toneMapping),T.push(y.numClippingPlanes),T.push(y.numClipIntersection),T.push(y.depthPacking)}function w(T,y){a.disableAll(),y.supportsVertexTextures&&a.enable(0),y.instancing&&a.enable(1),y.instancingColor&&a.enable(2),y.instancingMorph&&a.enable(3),y.matcap&&a.enable(4),y.envMap&&a.enable(5),y.normalMapObjectSpace&&a.enable(6),y.normalMapTangentSpace&&a.enable(7),y.clearcoat&&a.enable(8),y.iridescence&&a.enable(9),y.alphaTest&&a.enable(10),y.vertexColors&&a.enable(11),y.vertexAlphas&&a.enable(12),y.vertexUv1s&&a.enable(13),y.vertexUv2s&&a.enable(14),y.vertexUv3s&&a.enable(15),y.vertexTangents&&a.enable(16),y.anisotropy&&a.enable(17),y.alphaHash&&a.enable(18),y.batching&&a.enable(19),y.dispersion&&a.enable(20),y.batchingColor&&a.enable(21),T.push(a.mask),a.disableAll(),y.fog&&a.enable(0),y.useFog&&a.enable(1),y.flatShading&&a.enable(2),y.logarithmicDepthBuffer&&a.enable(3),y.reverseDepthBuffer&&a.enable(4),y.skinning&&a.enable(5),y.morphTargets&&a.enable(6),y.morphNormals&&a.enable(7),y.morphColors&&a.enable(8),y.premultipliedAlpha&&a.enable(9),y.shadowMapEnabled&&a.enable(10),y.doubleSided&&a.enable(11),y.flipSided&&a.enable(12),y.useDepthPacking&&a.enable(13),y.dithering&&a.enable(14),y.transmission&&a.enable(15),y.sheen&&a.enable(16),y.opaque&&a.enable(17),y.pointsUvs&&a.enable(18),y.decodeVideoTexture&&a.enable(19),y.decodeVideoTextureEmissive&&a.enable(20),y.alphaToCoverage&&a.enable(21),T.push(a.mask)}function M(T){const y=_[T.type];let R;if(y){const K=Ti[y];R=Ev.clone(K.uniforms)}else R=T.uniforms;return R}function B(T,y){let R;for(let K=0,F=u.length;K<F;K++){const G=u[K];if(G.cacheKey===y){R=G,++R.usedTimes;break}}return R===void 0&&(R=new Oy(i,y,T,r),u.push(R)),R}function D(T){if(--T.usedTimes===0){const y=u.indexOf(T);u[y]=u[u.length-1],u.pop(),T.destroy()}}function L(T){l.remove(T)}function U(){l.dispose()}return{getParameters:p,getProgramCacheKey:d,getUniforms:M,acquireProgram:B,releaseProgram:D,releaseShaderCache:L,programs:u,dispose:U}}function Hy(){let i=new WeakMap;function e(o){return i.has(o)}function t(o){let a=i.get(o);return a===void 0&&(a={},i.set(o,a)),a}function n(o){i.delete(o)}function s(o,a,l){i.get(o)[a]=l}function r(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:r}}function Gy(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.z!==e.z?i.z-e.z:i.id-e.id}function Vf(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function Hf(){const i=[];let e=0;const t=[],n=[],s=[];function r(){e=0,t.length=0,n.length=0,s.length=0}function o(h,f,m,_,v,p){let d=i[e];return d===void 0?(d={id:h.id,object:h,geometry:f,material:m,groupOrder:_,renderOrder:h.renderOrder,z:v,group:p},i[e]=d):(d.id=h.id,d.object=h,d.geometry=f,d.material=m,d.groupOrder=_,d.renderOrder=h.renderOrder,d.z=v,d.group=p),e++,d}function a(h,f,m,_,v,p){const d=o(h,f,m,_,v,p);m.transmission>0?n.push(d):m.transparent===!0?s.push(d):t.push(d)}function l(h,f,m,_,v,p){const d=o(h,f,m,_,v,p);m.transmission>0?n.unshift(d):m.transparent===!0?s.unshift(d):t.unshift(d)}function c(h,f){t.length>1&&t.sort(h||Gy),n.length>1&&n.sort(f||Vf),s.length>1&&s.sort(f||Vf)}function u(){for(let h=e,f=i.length;h<f;h++){const m=i[h];if(m.id===null)break;m.id=null,m.object=null,m.geometry=null,m.material=null,m.group=null}}return{opaque:t,transmissive:n,transparent:s,init:r,push:a,unshift:l,finish:u,sort:c}}function Wy(){let i=new WeakMap;function e(n,s){const r=i.get(n);let o;return r===void 0?(o=new Hf,i.set(n,[o])):s>=r.length?(o=new Hf,r.push(o)):o=r[s],o}function t(){i=new WeakMap}return{get:e,dispose:t}}function Xy(){const i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"DirectionalLight":t={direction:new H,color:new xt};break;case"SpotLight":t={position:new H,direction:new H,color:new xt,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new H,color:new xt,distance:0,decay:0};break;case"HemisphereLight":t={direction:new H,skyColor:new xt,groundColor:new xt};break;case"RectAreaLight":t={color:new xt,position:new H,halfWidth:new H,halfHeight:new H};break}return i[e.id]=t,t}}}function Yy(){const i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new nt};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new nt};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new nt,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}let qy=0;function jy(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function Ky(i){const e=new Xy,t=Yy(),n={version:0,hash:{directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new H);const s=new H,r=new Nt,o=new Nt;function a(c){let u=0,h=0,f=0;for(let T=0;T<9;T++)n.probe[T].set(0,0,0);let m=0,_=0,v=0,p=0,d=0,b=0,w=0,M=0,B=0,D=0,L=0;c.sort(jy);for(let T=0,y=c.length;T<y;T++){const R=c[T],K=R.color,F=R.intensity,G=R.distance,Z=R.shadow&&R.shadow.map?R.shadow.map.texture:null;if(R.isAmbientLight)u+=K.r*F,h+=K.g*F,f+=K.b*F;else if(R.isLightProbe){for(let j=0;j<9;j++)n.probe[j].addScaledVector(R.sh.coefficients[j],F);L++}else if(R.isDirectionalLight){const j=e.get(R);if(j.color.copy(R.color).multiplyScalar(R.intensity),R.castShadow){const ee=R.shadow,Q=t.get(R);Q.shadowIntensity=ee.intensity,Q.shadowBias=ee.bias,Q.shadowNormalBias=ee.normalBias,Q.shadowRadius=ee.radius,Q.shadowMapSize=ee.mapSize,n.directionalShadow[m]=Q,n.directionalShadowMap[m]=Z,n.directionalShadowMatrix[m]=R.shadow.matrix,b++}n.directional[m]=j,m++}else if(R.isSpotLight){const j=e.get(R);j.position.setFromMatrixPosition(R.matrixWorld),j.color.copy(K).multiplyScalar(F),j.distance=G,j.coneCos=Math.cos(R.angle),j.penumbraCos=Math.cos(R.angle*(1-R.penumbra)),j.decay=R.decay,n.spot[v]=j;const ee=R.shadow;if(R.map&&(n.spotLightMap[B]=R.map,B++,ee.updateMatrices(R),R.castShadow&&D++),n.spotLightMatrix[v]=ee.matrix,R.castShadow){const Q=t.get(R);Q.shadowIntensity=ee.intensity,Q.shadowBias=ee.bias,Q.shadowNormalBias=ee.normalBias,Q.shadowRadius=ee.radius,Q.shadowMapSize=ee.mapSize,n.spotShadow[v]=Q,n.spotShadowMap[v]=Z,M++}v++}else if(R.isRectAreaLight){const j=e.get(R);j.color.copy(K).multiplyScalar(F),j.halfWidth.set(R.width*.5,0,0),j.halfHeight.set(0,R.height*.5,0),n.rectArea[p]=j,p++}else if(R.isPointLight){const j=e.get(R);if(j.color.copy(R.color).multiplyScalar(R.intensity),j.distance=R.distance,j.decay=R.decay,R.castShadow){const ee=R.shadow,Q=t.get(R);Q.shadowIntensity=ee.intensity,Q.shadowBias=ee.bias,Q.shadowNormalBias=ee.normalBias,Q.shadowRadius=ee.radius,Q.shadowMapSize=ee.mapSize,Q.shadowCameraNear=ee.camera.near,Q.shadowCameraFar=ee.camera.far,n.pointShadow[_]=Q,n.pointShadowMap[_]=Z,n.pointShadowMatrix[_]=R.shadow.matrix,w++}n.point[_]=j,_++}else if(R.isHemisphereLight){const j=e.get(R);j.skyColor.copy(R.color).multiplyScalar(F),j.groundColor.copy(R.groundColor).multiplyScalar(F),n.hemi[d]=j,d++}}p>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=be.LTC_FLOAT_1,n.rectAreaLTC2=be.LTC_FLOAT_2):(n.rectAreaLTC1=be.LTC_HALF_1,n.rectAreaLTC2=be.LTC_HALF_2)),n.ambient[0]=u,n.ambient[1]=h,n.ambient[2]=f;const U=n.hash;(U.directionalLength!==m||U.pointLength!==_||U.spotLength!==v||U.rectAreaLength!==p||U.hemiLength!==d||U.numDirectionalShadows!==b||U.numPointShadows!==w||U.numSpotShadows!==M||U.numSpotMaps!==B||U.numLightProbes!==L)&&(n.directional.length=m,n.spot.length=v,n.rectArea.length=p,n.point.length=_,n.hemi.length=d,n.directionalShadow.length=b,n.directionalShadowMap.length=b,n.pointShadow.length=w,n.pointShadowMap.length=w,n.spotShadow.length=M,n.spotShadowMap.length=M,n.directionalShadowMatrix.length=b,n.pointShadowMatrix.length=w,n.spotLightMatrix.length=M+B-D,n.spotLightMap.length=B,n.numSpotLightShadowsWithMaps=D,n.numLightProbes=L,U.directionalLength=m,U.pointLength=_,U.spotLength=v,U.rectAreaLength=p,U.hemiLength=d,U.numDirectionalShadows=b,U.numPointShadows=w,U.numSpotShadows=M,U.numSpotMaps=B,U.numLightProbes=L,n.version=qy++)}function l(c,u){let h=0,f=0,m=0,_=0,v=0;const p=u.matrixWorldInverse;for(let d=0,b=c.length;d<b;d++){const w=c[d];if(w.isDirectionalLight){const M=n.directional[h];M.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(p),h++}else if(w.isSpotLight){const M=n.spot[m];M.position.setFromMatrixPosition(w.matrixWorld),M.position.applyMatrix4(p),M.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(p),m++}else if(w.isRectAreaLight){const M=n.rectArea[_];M.position.setFromMatrixPosition(w.matrixWorld),M.position.applyMatrix4(p),o.identity(),r.copy(w.matrixWorld),r.premultiply(p),o.extractRotation(r),M.halfWidth.set(w.width*.5,0,0),M.halfHeight.set(0,w.height*.5,0),M.halfWidth.applyMatrix4(o),M.halfHeight.applyMatrix4(o),_++}else if(w.isPointLight){const M=n.point[f];M.position.setFromMatrixPosition(w.matrixWorld),M.position.applyMatrix4(p),f++}else if(w.isHemisphereLight){const M=n.hemi[v];M.direction.setFromMatrixPosition(w.matrixWorld),M.direction.transformDirection(p),v++}}}return{setup:a,setupView:l,state:n}}function Gf(i){const e=new Ky(i),t=[],n=[];function s(u){c.camera=u,t.length=0,n.length=0}function r(u){t.push(u)}function o(u){n.push(u)}function a(){e.setup(t)}function l(u){e.setupView(t,u)}const c={lightsArray:t,shadowsArray:n,camera:null,lights:e,transmissionRenderTarget:{}};return{init:s,state:c,setupLights:a,setupLightsView:l,pushLight:r,pushShadow:o}}function Zy(i){let e=new WeakMap;function t(s,r=0){const o=e.get(s);let a;return o===void 0?(a=new Gf(i),e.set(s,[a])):r>=o.length?(a=new Gf(i),o.push(a)):a=o[r],a}function n(){e=new WeakMap}return{get:t,dispose:n}}class $y extends Vr{static get type(){return"MeshDepthMaterial"}constructor(e){super(),this.isMeshDepthMaterial=!0,this.depthPacking=P0,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}}class Jy extends Vr{static get type(){return"MeshDistanceMaterial"}constructor(e){super(),this.isMeshDistanceMaterial=!0,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}}const Qy=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,eE=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
#include <packing>
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = unpackRGBATo2Half( texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ) );
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = unpackRGBAToDepth( texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ) );
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( squared_mean - mean * mean );
	gl_FragColor = pack2HalfToRGBA( vec2( mean, std_dev ) );
}`;function tE(i,e,t){let n=new Up;const s=new nt,r=new nt,o=new Gt,a=new $y({depthPacking:D0}),l=new Jy,c={},u=t.maxTextureSize,h={[ps]:Ln,[Ln]:ps,[ki]:ki},f=new Ci({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new nt},radius:{value:4}},vertexShader:Qy,fragmentShader:eE}),m=f.clone();m.defines.HORIZONTAL_PASS=1;const _=new vn;_.setAttribute("position",new Cn(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));const v=new Ai(_,f),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=lp;let d=this.type;this.render=function(D,L,U){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||D.length===0)return;const T=i.getRenderTarget(),y=i.getActiveCubeFace(),R=i.getActiveMipmapLevel(),K=i.state;K.setBlending(hs),K.buffers.color.setClear(1,1,1,1),K.buffers.depth.setTest(!0),K.setScissorTest(!1);const F=d!==Bi&&this.type===Bi,G=d===Bi&&this.type!==Bi;for(let Z=0,j=D.length;Z<j;Z++){const ee=D[Z],Q=ee.shadow;if(Q===void 0){console.warn("THREE.WebGLShadowMap:",ee,"has no shadow.");continue}if(Q.autoUpdate===!1&&Q.needsUpdate===!1)continue;s.copy(Q.mapSize);const ue=Q.getFrameExtents();if(s.multiply(ue),r.copy(Q.mapSize),(s.x>u||s.y>u)&&(s.x>u&&(r.x=Math.floor(u/ue.x),s.x=r.x*ue.x,Q.mapSize.x=r.x),s.y>u&&(r.y=Math.floor(u/ue.y),s.y=r.y*ue.y,Q.mapSize.y=r.y)),Q.map===null||F===!0||G===!0){const me=this.type!==Bi?{minFilter:Xn,magFilter:Xn}:{};Q.map!==null&&Q.map.dispose(),Q.map=new ks(s.x,s.y,me),Q.map.texture.name=ee.name+".shadowMap",Q.camera.updateProjectionMatrix()}i.setRenderTarget(Q.map),i.clear();const ce=Q.getViewportCount();for(let me=0;me<ce;me++){const Se=Q.getViewport(me);o.set(r.x*Se.x,r.y*Se.y,r.x*Se.z,r.y*Se.w),K.viewport(o),Q.updateMatrices(ee,me),n=Q.getFrustum(),M(L,U,Q.camera,ee,this.type)}Q.isPointLightShadow!==!0&&this.type===Bi&&b(Q,U),Q.needsUpdate=!1}d=this.type,p.needsUpdate=!1,i.setRenderTarget(T,y,R)};function b(D,L){const U=e.update(v);f.defines.VSM_SAMPLES!==D.blurSamples&&(f.defines.VSM_SAMPLES=D.blurSamples,m.defines.VSM_SAMPLES=D.blurSamples,f.needsUpdate=!0,m.needsUpdate=!0),D.mapPass===null&&(D.mapPass=new ks(s.x,s.y)),f.uniforms.shadow_pass.value=D.map.texture,f.uniforms.resolution.value=D.mapSize,f.uniforms.radius.value=D.radius,i.setRenderTarget(D.mapPass),i.clear(),i.renderBufferDirect(L,null,U,f,v,null),m.uniforms.shadow_pass.value=D.mapPass.texture,m.uniforms.resolution.value=D.mapSize,m.uniforms.radius.value=D.radius,i.setRenderTarget(D.map),i.clear(),i.renderBufferDirect(L,null,U,m,v,null)}function w(D,L,U,T){let y=null;const R=U.isPointLight===!0?D.customDistanceMaterial:D.customDepthMaterial;if(R!==void 0)y=R;else if(y=U.isPointLight===!0?l:a,i.localClippingEnabled&&L.clipShadows===!0&&Array.isArray(L.clippingPlanes)&&L.clippingPlanes.length!==0||L.displacementMap&&L.displacementScale!==0||L.alphaMap&&L.alphaTest>0||L.map&&L.alphaTest>0){const K=y.uuid,F=L.uuid;let G=c[K];G===void 0&&(G={},c[K]=G);let Z=G[F];Z===void 0&&(Z=y.clone(),G[F]=Z,L.addEventListener("dispose",B)),y=Z}if(y.visible=L.visible,y.wireframe=L.wireframe,T===Bi?y.side=L.shadowSide!==null?L.shadowSide:L.side:y.side=L.shadowSide!==null?L.shadowSide:h[L.side],y.alphaMap=L.alphaMap,y.alphaTest=L.alphaTest,y.map=L.map,y.clipShadows=L.clipShadows,y.clippingPlanes=L.clippingPlanes,y.clipIntersection=L.clipIntersection,y.displacementMap=L.displacementMap,y.displacementScale=L.displacementScale,y.displacementBias=L.displacementBias,y.wireframeLinewidth=L.wireframeLinewidth,y.linewidth=L.linewidth,U.isPointLight===!0&&y.isMeshDistanceMaterial===!0){const K=i.properties.get(y);K.light=U}return y}function M(D,L,U,T,y){if(D.visible===!1)return;if(D.layers.test(L.layers)&&(D.isMesh||D.isLine||D.isPoints)&&(D.castShadow||D.receiveShadow&&y===Bi)&&(!D.frustumCulled||n.intersectsObject(D))){D.modelViewMatrix.multiplyMatrices(U.matrixWorldInverse,D.matrixWorld);const F=e.update(D),G=D.material;if(Array.isArray(G)){const Z=F.groups;for(let j=0,ee=Z.length;j<ee;j++){const Q=Z[j],ue=G[Q.materialIndex];if(ue&&ue.visible){const ce=w(D,ue,T,y);D.onBeforeShadow(i,D,L,U,F,ce,Q),i.renderBufferDirect(U,null,F,ce,D,Q),D.onAfterShadow(i,D,L,U,F,ce,Q)}}}else if(G.visible){const Z=w(D,G,T,y);D.onBeforeShadow(i,D,L,U,F,Z,null),i.renderBufferDirect(U,null,F,Z,D,null),D.onAfterShadow(i,D,L,U,F,Z,null)}}const K=D.children;for(let F=0,G=K.length;F<G;F++)M(K[F],L,U,T,y)}function B(D){D.target.removeEventListener("dispose",B);for(const U in c){const T=c[U],y=D.target.uuid;y in T&&(T[y].dispose(),delete T[y])}}}const nE={[hc]:uc,[fc]:mc,[dc]:gc,[Pr]:pc,[uc]:hc,[mc]:fc,[gc]:dc,[pc]:Pr};function iE(i,e){function t(){let O=!1;const xe=new Gt;let ne=null;const re=new Gt(0,0,0,0);return{setMask:function(we){ne!==we&&!O&&(i.colorMask(we,we,we,we),ne=we)},setLocked:function(we){O=we},setClear:function(we,Ae,Ze,Ft,nn){nn===!0&&(we*=Ft,Ae*=Ft,Ze*=Ft),xe.set(we,Ae,Ze,Ft),re.equals(xe)===!1&&(i.clearColor(we,Ae,Ze,Ft),re.copy(xe))},reset:function(){O=!1,ne=null,re.set(-1,0,0,0)}}}function n(){let O=!1,xe=!1,ne=null,re=null,we=null;return{setReversed:function(Ae){if(xe!==Ae){const Ze=e.get("EXT_clip_control");xe?Ze.clipControlEXT(Ze.LOWER_LEFT_EXT,Ze.ZERO_TO_ONE_EXT):Ze.clipControlEXT(Ze.LOWER_LEFT_EXT,Ze.NEGATIVE_ONE_TO_ONE_EXT);const Ft=we;we=null,this.setClear(Ft)}xe=Ae},getReversed:function(){return xe},setTest:function(Ae){Ae?oe(i.DEPTH_TEST):ke(i.DEPTH_TEST)},setMask:function(Ae){ne!==Ae&&!O&&(i.depthMask(Ae),ne=Ae)},setFunc:function(Ae){if(xe&&(Ae=nE[Ae]),re!==Ae){switch(Ae){case hc:i.depthFunc(i.NEVER);break;case uc:i.depthFunc(i.ALWAYS);break;case fc:i.depthFunc(i.LESS);break;case Pr:i.depthFunc(i.LEQUAL);break;case dc:i.depthFunc(i.EQUAL);break;case pc:i.depthFunc(i.GEQUAL);break;case mc:i.depthFunc(i.GREATER);break;case gc:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}re=Ae}},setLocked:function(Ae){O=Ae},setClear:function(Ae){we!==Ae&&(xe&&(Ae=1-Ae),i.clearDepth(Ae),we=Ae)},reset:function(){O=!1,ne=null,re=null,we=null,xe=!1}}}function s(){let O=!1,xe=null,ne=null,re=null,we=null,Ae=null,Ze=null,Ft=null,nn=null;return{setTest:function(gt){O||(gt?oe(i.STENCIL_TEST):ke(i.STENCIL_TEST))},setMask:function(gt){xe!==gt&&!O&&(i.stencilMask(gt),xe=gt)},setFunc:function(gt,Kt,Pt){(ne!==gt||re!==Kt||we!==Pt)&&(i.stencilFunc(gt,Kt,Pt),ne=gt,re=Kt,we=Pt)},setOp:function(gt,Kt,Pt){(Ae!==gt||Ze!==Kt||Ft!==Pt)&&(i.stencilOp(gt,Kt,Pt),Ae=gt,Ze=Kt,Ft=Pt)},setLocked:function(gt){O=gt},setClear:function(gt){nn!==gt&&(i.clearStencil(gt),nn=gt)},reset:function(){O=!1,xe=null,ne=null,re=null,we=null,Ae=null,Ze=null,Ft=null,nn=null}}}const r=new t,o=new n,a=new s,l=new WeakMap,c=new WeakMap;let u={},h={},f=new WeakMap,m=[],_=null,v=!1,p=null,d=null,b=null,w=null,M=null,B=null,D=null,L=new xt(0,0,0),U=0,T=!1,y=null,R=null,K=null,F=null,G=null;const Z=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS);let j=!1,ee=0;const Q=i.getParameter(i.VERSION);Q.indexOf("WebGL")!==-1?(ee=parseFloat(/^WebGL (\d)/.exec(Q)[1]),j=ee>=1):Q.indexOf("OpenGL ES")!==-1&&(ee=parseFloat(/^OpenGL ES (\d)/.exec(Q)[1]),j=ee>=2);let ue=null,ce={};const me=i.getParameter(i.SCISSOR_BOX),Se=i.getParameter(i.VIEWPORT),pe=new Gt().fromArray(me),ie=new Gt().fromArray(Se);function ae(O,xe,ne,re){const we=new Uint8Array(4),Ae=i.createTexture();i.bindTexture(O,Ae),i.texParameteri(O,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(O,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let Ze=0;Ze<ne;Ze++)O===i.TEXTURE_3D||O===i.TEXTURE_2D_ARRAY?i.texImage3D(xe,0,i.RGBA,1,1,re,0,i.RGBA,i.UNSIGNED_BYTE,we):i.texImage2D(xe+Ze,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,we);return Ae}const ge={};ge[i.TEXTURE_2D]=ae(i.TEXTURE_2D,i.TEXTURE_2D,1),ge[i.TEXTURE_CUBE_MAP]=ae(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),ge[i.TEXTURE_2D_ARRAY]=ae(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),ge[i.TEXTURE_3D]=ae(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),oe(i.DEPTH_TEST),o.setFunc(Pr),$e(!1),Qe(Yu),oe(i.CULL_FACE),k(hs);function oe(O){u[O]!==!0&&(i.enable(O),u[O]=!0)}function ke(O){u[O]!==!1&&(i.disable(O),u[O]=!1)}function Ve(O,xe){return h[O]!==xe?(i.bindFramebuffer(O,xe),h[O]=xe,O===i.DRAW_FRAMEBUFFER&&(h[i.FRAMEBUFFER]=xe),O===i.FRAMEBUFFER&&(h[i.DRAW_FRAMEBUFFER]=xe),!0):!1}function Ie(O,xe){let ne=m,re=!1;if(O){ne=f.get(xe),ne===void 0&&(ne=[],f.set(xe,ne));const we=O.textures;if(ne.length!==we.length||ne[0]!==i.COLOR_ATTACHMENT0){for(let Ae=0,Ze=we.length;Ae<Ze;Ae++)ne[Ae]=i.COLOR_ATTACHMENT0+Ae;ne.length=we.length,re=!0}}else ne[0]!==i.BACK&&(ne[0]=i.BACK,re=!0);re&&i.drawBuffers(ne)}function ot(O){return _!==O?(i.useProgram(O),_=O,!0):!1}const Ke={[Ls]:i.FUNC_ADD,[i0]:i.FUNC_SUBTRACT,[s0]:i.FUNC_REVERSE_SUBTRACT};Ke[r0]=i.MIN,Ke[o0]=i.MAX;const at={[a0]:i.ZERO,[l0]:i.ONE,[c0]:i.SRC_COLOR,[lc]:i.SRC_ALPHA,[m0]:i.SRC_ALPHA_SATURATE,[d0]:i.DST_COLOR,[u0]:i.DST_ALPHA,[h0]:i.ONE_MINUS_SRC_COLOR,[cc]:i.ONE_MINUS_SRC_ALPHA,[p0]:i.ONE_MINUS_DST_COLOR,[f0]:i.ONE_MINUS_DST_ALPHA,[g0]:i.CONSTANT_COLOR,[_0]:i.ONE_MINUS_CONSTANT_COLOR,[v0]:i.CONSTANT_ALPHA,[x0]:i.ONE_MINUS_CONSTANT_ALPHA};function k(O,xe,ne,re,we,Ae,Ze,Ft,nn,gt){if(O===hs){v===!0&&(ke(i.BLEND),v=!1);return}if(v===!1&&(oe(i.BLEND),v=!0),O!==n0){if(O!==p||gt!==T){if((d!==Ls||M!==Ls)&&(i.blendEquation(i.FUNC_ADD),d=Ls,M=Ls),gt)switch(O){case yr:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case qu:i.blendFunc(i.ONE,i.ONE);break;case ju:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case Ku:i.blendFuncSeparate(i.ZERO,i.SRC_COLOR,i.ZERO,i.SRC_ALPHA);break;default:console.error("THREE.WebGLState: Invalid blending: ",O);break}else switch(O){case yr:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case qu:i.blendFunc(i.SRC_ALPHA,i.ONE);break;case ju:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case Ku:i.blendFunc(i.ZERO,i.SRC_COLOR);break;default:console.error("THREE.WebGLState: Invalid blending: ",O);break}b=null,w=null,B=null,D=null,L.set(0,0,0),U=0,p=O,T=gt}return}we=we||xe,Ae=Ae||ne,Ze=Ze||re,(xe!==d||we!==M)&&(i.blendEquationSeparate(Ke[xe],Ke[we]),d=xe,M=we),(ne!==b||re!==w||Ae!==B||Ze!==D)&&(i.blendFuncSeparate(at[ne],at[re],at[Ae],at[Ze]),b=ne,w=re,B=Ae,D=Ze),(Ft.equals(L)===!1||nn!==U)&&(i.blendColor(Ft.r,Ft.g,Ft.b,nn),L.copy(Ft),U=nn),p=O,T=!1}function jt(O,xe){O.side===ki?ke(i.CULL_FACE):oe(i.CULL_FACE);let ne=O.side===Ln;xe&&(ne=!ne),$e(ne),O.blending===yr&&O.transparent===!1?k(hs):k(O.blending,O.blendEquation,O.blendSrc,O.blendDst,O.blendEquationAlpha,O.blendSrcAlpha,O.blendDstAlpha,O.blendColor,O.blendAlpha,O.premultipliedAlpha),o.setFunc(O.depthFunc),o.setTest(O.depthTest),o.setMask(O.depthWrite),r.setMask(O.colorWrite);const re=O.stencilWrite;a.setTest(re),re&&(a.setMask(O.stencilWriteMask),a.setFunc(O.stencilFunc,O.stencilRef,O.stencilFuncMask),a.setOp(O.stencilFail,O.stencilZFail,O.stencilZPass)),ct(O.polygonOffset,O.polygonOffsetFactor,O.polygonOffsetUnits),O.alphaToCoverage===!0?oe(i.SAMPLE_ALPHA_TO_COVERAGE):ke(i.SAMPLE_ALPHA_TO_COVERAGE)}function $e(O){y!==O&&(O?i.frontFace(i.CW):i.frontFace(i.CCW),y=O)}function Qe(O){O!==Q_?(oe(i.CULL_FACE),O!==R&&(O===Yu?i.cullFace(i.BACK):O===e0?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):ke(i.CULL_FACE),R=O}function He(O){O!==K&&(j&&i.lineWidth(O),K=O)}function ct(O,xe,ne){O?(oe(i.POLYGON_OFFSET_FILL),(F!==xe||G!==ne)&&(i.polygonOffset(xe,ne),F=xe,G=ne)):ke(i.POLYGON_OFFSET_FILL)}function Pe(O){O?oe(i.SCISSOR_TEST):ke(i.SCISSOR_TEST)}function C(O){O===void 0&&(O=i.TEXTURE0+Z-1),ue!==O&&(i.activeTexture(O),ue=O)}function S(O,xe,ne){ne===void 0&&(ue===null?ne=i.TEXTURE0+Z-1:ne=ue);let re=ce[ne];re===void 0&&(re={type:void 0,texture:void 0},ce[ne]=re),(re.type!==O||re.texture!==xe)&&(ue!==ne&&(i.activeTexture(ne),ue=ne),i.bindTexture(O,xe||ge[O]),re.type=O,re.texture=xe)}function q(){const O=ce[ue];O!==void 0&&O.type!==void 0&&(i.bindTexture(O.type,null),O.type=void 0,O.texture=void 0)}function J(){try{i.compressedTexImage2D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function V(){try{i.compressedTexImage3D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function te(){try{i.texSubImage2D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function Me(){try{i.texSubImage3D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function _e(){try{i.compressedTexSubImage2D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function Te(){try{i.compressedTexSubImage3D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function je(){try{i.texStorage2D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function fe(){try{i.texStorage3D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function ve(){try{i.texImage2D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function Ne(){try{i.texImage3D.apply(i,arguments)}catch(O){console.error("THREE.WebGLState:",O)}}function Oe(O){pe.equals(O)===!1&&(i.scissor(O.x,O.y,O.z,O.w),pe.copy(O))}function Ee(O){ie.equals(O)===!1&&(i.viewport(O.x,O.y,O.z,O.w),ie.copy(O))}function tt(O,xe){let ne=c.get(xe);ne===void 0&&(ne=new WeakMap,c.set(xe,ne));let re=ne.get(O);re===void 0&&(re=i.getUniformBlockIndex(xe,O.name),ne.set(O,re))}function Ye(O,xe){const re=c.get(xe).get(O);l.get(xe)!==re&&(i.uniformBlockBinding(xe,re,O.__bindingPointIndex),l.set(xe,re))}function ht(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),u={},ue=null,ce={},h={},f=new WeakMap,m=[],_=null,v=!1,p=null,d=null,b=null,w=null,M=null,B=null,D=null,L=new xt(0,0,0),U=0,T=!1,y=null,R=null,K=null,F=null,G=null,pe.set(0,0,i.canvas.width,i.canvas.height),ie.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:oe,disable:ke,bindFramebuffer:Ve,drawBuffers:Ie,useProgram:ot,setBlending:k,setMaterial:jt,setFlipSided:$e,setCullFace:Qe,setLineWidth:He,setPolygonOffset:ct,setScissorTest:Pe,activeTexture:C,bindTexture:S,unbindTexture:q,compressedTexImage2D:J,compressedTexImage3D:V,texImage2D:ve,texImage3D:Ne,updateUBOMapping:tt,uniformBlockBinding:Ye,texStorage2D:je,texStorage3D:fe,texSubImage2D:te,texSubImage3D:Me,compressedTexSubImage2D:_e,compressedTexSubImage3D:Te,scissor:Oe,viewport:Ee,reset:ht}}function Wf(i,e,t,n){const s=sE(n);switch(t){case pp:return i*e;case gp:return i*e;case _p:return i*e*2;case vp:return i*e/s.components*s.byteLength;case xh:return i*e/s.components*s.byteLength;case xp:return i*e*2/s.components*s.byteLength;case Sh:return i*e*2/s.components*s.byteLength;case mp:return i*e*3/s.components*s.byteLength;case mi:return i*e*4/s.components*s.byteLength;case Mh:return i*e*4/s.components*s.byteLength;case fa:case da:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case pa:case ma:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case yc:case bc:return Math.max(i,16)*Math.max(e,8)/4;case Mc:case Ec:return Math.max(i,8)*Math.max(e,8)/2;case Tc:case wc:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Ac:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Cc:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Rc:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case Pc:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case Dc:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case Lc:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case Uc:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case Ic:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case Nc:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case Fc:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case Oc:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case Bc:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case kc:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case zc:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case Vc:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case ga:case Hc:case Gc:return Math.ceil(i/4)*Math.ceil(e/4)*16;case Sp:case Wc:return Math.ceil(i/4)*Math.ceil(e/4)*8;case Xc:case Yc:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function sE(i){switch(i){case Yi:case up:return{byteLength:1,components:1};case vo:case fp:case Eo:return{byteLength:2,components:1};case _h:case vh:return{byteLength:2,components:4};case Bs:case gh:case zi:return{byteLength:4,components:1};case dp:return{byteLength:4,components:3}}throw new Error(`Unknown texture type ${i}.`)}function rE(i,e,t,n,s,r,o){const a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new nt,u=new WeakMap;let h;const f=new WeakMap;let m=!1;try{m=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function _(C,S){return m?new OffscreenCanvas(C,S):ba("canvas")}function v(C,S,q){let J=1;const V=Pe(C);if((V.width>q||V.height>q)&&(J=q/Math.max(V.width,V.height)),J<1)if(typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&C instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&C instanceof ImageBitmap||typeof VideoFrame<"u"&&C instanceof VideoFrame){const te=Math.floor(J*V.width),Me=Math.floor(J*V.height);h===void 0&&(h=_(te,Me));const _e=S?_(te,Me):h;return _e.width=te,_e.height=Me,_e.getContext("2d").drawImage(C,0,0,te,Me),console.warn("THREE.WebGLRenderer: Texture has been resized from ("+V.width+"x"+V.height+") to ("+te+"x"+Me+")."),_e}else return"data"in C&&console.warn("THREE.WebGLRenderer: Image in DataTexture is too big ("+V.width+"x"+V.height+")."),C;return C}function p(C){return C.generateMipmaps}function d(C){i.generateMipmap(C)}function b(C){return C.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:C.isWebGL3DRenderTarget?i.TEXTURE_3D:C.isWebGLArrayRenderTarget||C.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function w(C,S,q,J,V=!1){if(C!==null){if(i[C]!==void 0)return i[C];console.warn("THREE.WebGLRenderer: Attempt to use non-existing WebGL internal format '"+C+"'")}let te=S;if(S===i.RED&&(q===i.FLOAT&&(te=i.R32F),q===i.HALF_FLOAT&&(te=i.R16F),q===i.UNSIGNED_BYTE&&(te=i.R8)),S===i.RED_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.R8UI),q===i.UNSIGNED_SHORT&&(te=i.R16UI),q===i.UNSIGNED_INT&&(te=i.R32UI),q===i.BYTE&&(te=i.R8I),q===i.SHORT&&(te=i.R16I),q===i.INT&&(te=i.R32I)),S===i.RG&&(q===i.FLOAT&&(te=i.RG32F),q===i.HALF_FLOAT&&(te=i.RG16F),q===i.UNSIGNED_BYTE&&(te=i.RG8)),S===i.RG_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RG8UI),q===i.UNSIGNED_SHORT&&(te=i.RG16UI),q===i.UNSIGNED_INT&&(te=i.RG32UI),q===i.BYTE&&(te=i.RG8I),q===i.SHORT&&(te=i.RG16I),q===i.INT&&(te=i.RG32I)),S===i.RGB_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RGB8UI),q===i.UNSIGNED_SHORT&&(te=i.RGB16UI),q===i.UNSIGNED_INT&&(te=i.RGB32UI),q===i.BYTE&&(te=i.RGB8I),q===i.SHORT&&(te=i.RGB16I),q===i.INT&&(te=i.RGB32I)),S===i.RGBA_INTEGER&&(q===i.UNSIGNED_BYTE&&(te=i.RGBA8UI),q===i.UNSIGNED_SHORT&&(te=i.RGBA16UI),q===i.UNSIGNED_INT&&(te=i.RGBA32UI),q===i.BYTE&&(te=i.RGBA8I),q===i.SHORT&&(te=i.RGBA16I),q===i.INT&&(te=i.RGBA32I)),S===i.RGB&&q===i.UNSIGNED_INT_5_9_9_9_REV&&(te=i.RGB9_E5),S===i.RGBA){const Me=V?Va:ft.getTransfer(J);q===i.FLOAT&&(te=i.RGBA32F),q===i.HALF_FLOAT&&(te=i.RGBA16F),q===i.UNSIGNED_BYTE&&(te=Me===Tt?i.SRGB8_ALPHA8:i.RGBA8),q===i.UNSIGNED_SHORT_4_4_4_4&&(te=i.RGBA4),q===i.UNSIGNED_SHORT_5_5_5_1&&(te=i.RGB5_A1)}return(te===i.R16F||te===i.R32F||te===i.RG16F||te===i.RG32F||te===i.RGBA16F||te===i.RGBA32F)&&e.get("EXT_color_buffer_float"),te}function M(C,S){let q;return C?S===null||S===Bs||S===Ur?q=i.DEPTH24_STENCIL8:S===zi?q=i.DEPTH32F_STENCIL8:S===vo&&(q=i.DEPTH24_STENCIL8,console.warn("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):S===null||S===Bs||S===Ur?q=i.DEPTH_COMPONENT24:S===zi?q=i.DEPTH_COMPONENT32F:S===vo&&(q=i.DEPTH_COMPONENT16),q}function B(C,S){return p(C)===!0||C.isFramebufferTexture&&C.minFilter!==Xn&&C.minFilter!==pi?Math.log2(Math.max(S.width,S.height))+1:C.mipmaps!==void 0&&C.mipmaps.length>0?C.mipmaps.length:C.isCompressedTexture&&Array.isArray(C.image)?S.mipmaps.length:1}function D(C){const S=C.target;S.removeEventListener("dispose",D),U(S),S.isVideoTexture&&u.delete(S)}function L(C){const S=C.target;S.removeEventListener("dispose",L),y(S)}function U(C){const S=n.get(C);if(S.__webglInit===void 0)return;const q=C.source,J=f.get(q);if(J){const V=J[S.__cacheKey];V.usedTimes--,V.usedTimes===0&&T(C),Object.keys(J).length===0&&f.delete(q)}n.remove(C)}function T(C){const S=n.get(C);i.deleteTexture(S.__webglTexture);const q=C.source,J=f.get(q);delete J[S.__cacheKey],o.memory.textures--}function y(C){const S=n.get(C);if(C.depthTexture&&(C.depthTexture.dispose(),n.remove(C.depthTexture)),C.isWebGLCubeRenderTarget)for(let J=0;J<6;J++){if(Array.isArray(S.__webglFramebuffer[J]))for(let V=0;V<S.__webglFramebuffer[J].length;V++)i.deleteFramebuffer(S.__webglFramebuffer[J][V]);else i.deleteFramebuffer(S.__webglFramebuffer[J]);S.__webglDepthbuffer&&i.deleteRenderbuffer(S.__webglDepthbuffer[J])}else{if(Array.isArray(S.__webglFramebuffer))for(let J=0;J<S.__webglFramebuffer.length;J++)i.deleteFramebuffer(S.__webglFramebuffer[J]);else i.deleteFramebuffer(S.__webglFramebuffer);if(S.__webglDepthbuffer&&i.deleteRenderbuffer(S.__webglDepthbuffer),S.__webglMultisampledFramebuffer&&i.deleteFramebuffer(S.__webglMultisampledFramebuffer),S.__webglColorRenderbuffer)for(let J=0;J<S.__webglColorRenderbuffer.length;J++)S.__webglColorRenderbuffer[J]&&i.deleteRenderbuffer(S.__webglColorRenderbuffer[J]);S.__webglDepthRenderbuffer&&i.deleteRenderbuffer(S.__webglDepthRenderbuffer)}const q=C.textures;for(let J=0,V=q.length;J<V;J++){const te=n.get(q[J]);te.__webglTexture&&(i.deleteTexture(te.__webglTexture),o.memory.textures--),n.remove(q[J])}n.remove(C)}let R=0;function K(){R=0}function F(){const C=R;return C>=s.maxTextures&&console.warn("THREE.WebGLTextures: Trying to use "+C+" texture units while this GPU supports only "+s.maxTextures),R+=1,C}function G(C){const S=[];return S.push(C.wrapS),S.push(C.wrapT),S.push(C.wrapR||0),S.push(C.magFilter),S.push(C.minFilter),S.push(C.anisotropy),S.push(C.internalFormat),S.push(C.format),S.push(C.type),S.push(C.generateMipmaps),S.push(C.premultiplyAlpha),S.push(C.flipY),S.push(C.unpackAlignment),S.push(C.colorSpace),S.join()}function Z(C,S){const q=n.get(C);if(C.isVideoTexture&&He(C),C.isRenderTargetTexture===!1&&C.version>0&&q.__version!==C.version){const J=C.image;if(J===null)console.warn("THREE.WebGLRenderer: Texture marked for update but no image data found.");else if(J.complete===!1)console.warn("THREE.WebGLRenderer: Texture marked for update but image is incomplete");else{ie(q,C,S);return}}t.bindTexture(i.TEXTURE_2D,q.__webglTexture,i.TEXTURE0+S)}function j(C,S){const q=n.get(C);if(C.version>0&&q.__version!==C.version){ie(q,C,S);return}t.bindTexture(i.TEXTURE_2D_ARRAY,q.__webglTexture,i.TEXTURE0+S)}function ee(C,S){const q=n.get(C);if(C.version>0&&q.__version!==C.version){ie(q,C,S);return}t.bindTexture(i.TEXTURE_3D,q.__webglTexture,i.TEXTURE0+S)}function Q(C,S){const q=n.get(C);if(C.version>0&&q.__version!==C.version){ae(q,C,S);return}t.bindTexture(i.TEXTURE_CUBE_MAP,q.__webglTexture,i.TEXTURE0+S)}const ue={[xc]:i.REPEAT,[Is]:i.CLAMP_TO_EDGE,[Sc]:i.MIRRORED_REPEAT},ce={[Xn]:i.NEAREST,[R0]:i.NEAREST_MIPMAP_NEAREST,[Bo]:i.NEAREST_MIPMAP_LINEAR,[pi]:i.LINEAR,[gl]:i.LINEAR_MIPMAP_NEAREST,[Ns]:i.LINEAR_MIPMAP_LINEAR},me={[I0]:i.NEVER,[z0]:i.ALWAYS,[N0]:i.LESS,[Mp]:i.LEQUAL,[F0]:i.EQUAL,[k0]:i.GEQUAL,[O0]:i.GREATER,[B0]:i.NOTEQUAL};function Se(C,S){if(S.type===zi&&e.has("OES_texture_float_linear")===!1&&(S.magFilter===pi||S.magFilter===gl||S.magFilter===Bo||S.magFilter===Ns||S.minFilter===pi||S.minFilter===gl||S.minFilter===Bo||S.minFilter===Ns)&&console.warn("THREE.WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(C,i.TEXTURE_WRAP_S,ue[S.wrapS]),i.texParameteri(C,i.TEXTURE_WRAP_T,ue[S.wrapT]),(C===i.TEXTURE_3D||C===i.TEXTURE_2D_ARRAY)&&i.texParameteri(C,i.TEXTURE_WRAP_R,ue[S.wrapR]),i.texParameteri(C,i.TEXTURE_MAG_FILTER,ce[S.magFilter]),i.texParameteri(C,i.TEXTURE_MIN_FILTER,ce[S.minFilter]),S.compareFunction&&(i.texParameteri(C,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(C,i.TEXTURE_COMPARE_FUNC,me[S.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(S.magFilter===Xn||S.minFilter!==Bo&&S.minFilter!==Ns||S.type===zi&&e.has("OES_texture_float_linear")===!1)return;if(S.anisotropy>1||n.get(S).__currentAnisotropy){const q=e.get("EXT_texture_filter_anisotropic");i.texParameterf(C,q.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(S.anisotropy,s.getMaxAnisotropy())),n.get(S).__currentAnisotropy=S.anisotropy}}}function pe(C,S){let q=!1;C.__webglInit===void 0&&(C.__webglInit=!0,S.addEventListener("dispose",D));const J=S.source;let V=f.get(J);V===void 0&&(V={},f.set(J,V));const te=G(S);if(te!==C.__cacheKey){V[te]===void 0&&(V[te]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,q=!0),V[te].usedTimes++;const Me=V[C.__cacheKey];Me!==void 0&&(V[C.__cacheKey].usedTimes--,Me.usedTimes===0&&T(S)),C.__cacheKey=te,C.__webglTexture=V[te].texture}return q}function ie(C,S,q){let J=i.TEXTURE_2D;(S.isDataArrayTexture||S.isCompressedArrayTexture)&&(J=i.TEXTURE_2D_ARRAY),S.isData3DTexture&&(J=i.TEXTURE_3D);const V=pe(C,S),te=S.source;t.bindTexture(J,C.__webglTexture,i.TEXTURE0+q);const Me=n.get(te);if(te.version!==Me.__version||V===!0){t.activeTexture(i.TEXTURE0+q);const _e=ft.getPrimaries(ft.workingColorSpace),Te=S.colorSpace===ls?null:ft.getPrimaries(S.colorSpace),je=S.colorSpace===ls||_e===Te?i.NONE:i.BROWSER_DEFAULT_WEBGL;i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,S.flipY),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,S.premultiplyAlpha),i.pixelStorei(i.UNPACK_ALIGNMENT,S.unpackAlignment),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,je);let fe=v(S.image,!1,s.maxTextureSize);fe=ct(S,fe);const ve=r.convert(S.format,S.colorSpace),Ne=r.convert(S.type);let Oe=w(S.internalFormat,ve,Ne,S.colorSpace,S.isVideoTexture);Se(J,S);let Ee;const tt=S.mipmaps,Ye=S.isVideoTexture!==!0,ht=Me.__version===void 0||V===!0,O=te.dataReady,xe=B(S,fe);if(S.isDepthTexture)Oe=M(S.format===Ir,S.type),ht&&(Ye?t.texStorage2D(i.TEXTURE_2D,1,Oe,fe.width,fe.height):t.texImage2D(i.TEXTURE_2D,0,Oe,fe.width,fe.height,0,ve,Ne,null));else if(S.isDataTexture)if(tt.length>0){Ye&&ht&&t.texStorage2D(i.TEXTURE_2D,xe,Oe,tt[0].width,tt[0].height);for(let ne=0,re=tt.length;ne<re;ne++)Ee=tt[ne],Ye?O&&t.texSubImage2D(i.TEXTURE_2D,ne,0,0,Ee.width,Ee.height,ve,Ne,Ee.data):t.texImage2D(i.TEXTURE_2D,ne,Oe,Ee.width,Ee.height,0,ve,Ne,Ee.data);S.generateMipmaps=!1}else Ye?(ht&&t.texStorage2D(i.TEXTURE_2D,xe,Oe,fe.width,fe.height),O&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,fe.width,fe.height,ve,Ne,fe.data)):t.texImage2D(i.TEXTURE_2D,0,Oe,fe.width,fe.height,0,ve,Ne,fe.data);else if(S.isCompressedTexture)if(S.isCompressedArrayTexture){Ye&&ht&&t.texStorage3D(i.TEXTURE_2D_ARRAY,xe,Oe,tt[0].width,tt[0].height,fe.depth);for(let ne=0,re=tt.length;ne<re;ne++)if(Ee=tt[ne],S.format!==mi)if(ve!==null)if(Ye){if(O)if(S.layerUpdates.size>0){const we=Wf(Ee.width,Ee.height,S.format,S.type);for(const Ae of S.layerUpdates){const Ze=Ee.data.subarray(Ae*we/Ee.data.BYTES_PER_ELEMENT,(Ae+1)*we/Ee.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ne,0,0,Ae,Ee.width,Ee.height,1,ve,Ze)}S.clearLayerUpdates()}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,ne,0,0,0,Ee.width,Ee.height,fe.depth,ve,Ee.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,ne,Oe,Ee.width,Ee.height,fe.depth,0,Ee.data,0,0);else console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else Ye?O&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,ne,0,0,0,Ee.width,Ee.height,fe.depth,ve,Ne,Ee.data):t.texImage3D(i.TEXTURE_2D_ARRAY,ne,Oe,Ee.width,Ee.height,fe.depth,0,ve,Ne,Ee.data)}else{Ye&&ht&&t.texStorage2D(i.TEXTURE_2D,xe,Oe,tt[0].width,tt[0].height);for(let ne=0,re=tt.length;ne<re;ne++)Ee=tt[ne],S.format!==mi?ve!==null?Ye?O&&t.compressedTexSubImage2D(i.TEXTURE_2D,ne,0,0,Ee.width,Ee.height,ve,Ee.data):t.compressedTexImage2D(i.TEXTURE_2D,ne,Oe,Ee.width,Ee.height,0,Ee.data):console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):Ye?O&&t.texSubImage2D(i.TEXTURE_2D,ne,0,0,Ee.width,Ee.height,ve,Ne,Ee.data):t.texImage2D(i.TEXTURE_2D,ne,Oe,Ee.width,Ee.height,0,ve,Ne,Ee.data)}else if(S.isDataArrayTexture)if(Ye){if(ht&&t.texStorage3D(i.TEXTURE_2D_ARRAY,xe,Oe,fe.width,fe.height,fe.depth),O)if(S.layerUpdates.size>0){const ne=Wf(fe.width,fe.height,S.format,S.type);for(const re of S.layerUpdates){const we=fe.data.subarray(re*ne/fe.data.BYTES_PER_ELEMENT,(re+1)*ne/fe.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,re,fe.width,fe.height,1,ve,Ne,we)}S.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,fe.width,fe.height,fe.depth,ve,Ne,fe.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,Oe,fe.width,fe.height,fe.depth,0,ve,Ne,fe.data);else if(S.isData3DTexture)Ye?(ht&&t.texStorage3D(i.TEXTURE_3D,xe,Oe,fe.width,fe.height,fe.depth),O&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,fe.width,fe.height,fe.depth,ve,Ne,fe.data)):t.texImage3D(i.TEXTURE_3D,0,Oe,fe.width,fe.height,fe.depth,0,ve,Ne,fe.data);else if(S.isFramebufferTexture){if(ht)if(Ye)t.texStorage2D(i.TEXTURE_2D,xe,Oe,fe.width,fe.height);else{let ne=fe.width,re=fe.height;for(let we=0;we<xe;we++)t.texImage2D(i.TEXTURE_2D,we,Oe,ne,re,0,ve,Ne,null),ne>>=1,re>>=1}}else if(tt.length>0){if(Ye&&ht){const ne=Pe(tt[0]);t.texStorage2D(i.TEXTURE_2D,xe,Oe,ne.width,ne.height)}for(let ne=0,re=tt.length;ne<re;ne++)Ee=tt[ne],Ye?O&&t.texSubImage2D(i.TEXTURE_2D,ne,0,0,ve,Ne,Ee):t.texImage2D(i.TEXTURE_2D,ne,Oe,ve,Ne,Ee);S.generateMipmaps=!1}else if(Ye){if(ht){const ne=Pe(fe);t.texStorage2D(i.TEXTURE_2D,xe,Oe,ne.width,ne.height)}O&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,ve,Ne,fe)}else t.texImage2D(i.TEXTURE_2D,0,Oe,ve,Ne,fe);p(S)&&d(J),Me.__version=te.version,S.onUpdate&&S.onUpdate(S)}C.__version=S.version}function ae(C,S,q){if(S.image.length!==6)return;const J=pe(C,S),V=S.source;t.bindTexture(i.TEXTURE_CUBE_MAP,C.__webglTexture,i.TEXTURE0+q);const te=n.get(V);if(V.version!==te.__version||J===!0){t.activeTexture(i.TEXTURE0+q);const Me=ft.getPrimaries(ft.workingColorSpace),_e=S.colorSpace===ls?null:ft.getPrimaries(S.colorSpace),Te=S.colorSpace===ls||Me===_e?i.NONE:i.BROWSER_DEFAULT_WEBGL;i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,S.flipY),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,S.premultiplyAlpha),i.pixelStorei(i.UNPACK_ALIGNMENT,S.unpackAlignment),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Te);const je=S.isCompressedTexture||S.image[0].isCompressedTexture,fe=S.image[0]&&S.image[0].isDataTexture,ve=[];for(let re=0;re<6;re++)!je&&!fe?ve[re]=v(S.image[re],!0,s.maxCubemapSize):ve[re]=fe?S.image[re].image:S.image[re],ve[re]=ct(S,ve[re]);const Ne=ve[0],Oe=r.convert(S.format,S.colorSpace),Ee=r.convert(S.type),tt=w(S.internalFormat,Oe,Ee,S.colorSpace),Ye=S.isVideoTexture!==!0,ht=te.__version===void 0||J===!0,O=V.dataReady;let xe=B(S,Ne);Se(i.TEXTURE_CUBE_MAP,S);let ne;if(je){Ye&&ht&&t.texStorage2D(i.TEXTURE_CUBE_MAP,xe,tt,Ne.width,Ne.height);for(let re=0;re<6;re++){ne=ve[re].mipmaps;for(let we=0;we<ne.length;we++){const Ae=ne[we];S.format!==mi?Oe!==null?Ye?O&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we,0,0,Ae.width,Ae.height,Oe,Ae.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we,tt,Ae.width,Ae.height,0,Ae.data):console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Ye?O&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we,0,0,Ae.width,Ae.height,Oe,Ee,Ae.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we,tt,Ae.width,Ae.height,0,Oe,Ee,Ae.data)}}}else{if(ne=S.mipmaps,Ye&&ht){ne.length>0&&xe++;const re=Pe(ve[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,xe,tt,re.width,re.height)}for(let re=0;re<6;re++)if(fe){Ye?O&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,0,0,0,ve[re].width,ve[re].height,Oe,Ee,ve[re].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,0,tt,ve[re].width,ve[re].height,0,Oe,Ee,ve[re].data);for(let we=0;we<ne.length;we++){const Ze=ne[we].image[re].image;Ye?O&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we+1,0,0,Ze.width,Ze.height,Oe,Ee,Ze.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we+1,tt,Ze.width,Ze.height,0,Oe,Ee,Ze.data)}}else{Ye?O&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,0,0,0,Oe,Ee,ve[re]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,0,tt,Oe,Ee,ve[re]);for(let we=0;we<ne.length;we++){const Ae=ne[we];Ye?O&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we+1,0,0,Oe,Ee,Ae.image[re]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+re,we+1,tt,Oe,Ee,Ae.image[re])}}}p(S)&&d(i.TEXTURE_CUBE_MAP),te.__version=V.version,S.onUpdate&&S.onUpdate(S)}C.__version=S.version}function ge(C,S,q,J,V,te){const Me=r.convert(q.format,q.colorSpace),_e=r.convert(q.type),Te=w(q.internalFormat,Me,_e,q.colorSpace),je=n.get(S),fe=n.get(q);if(fe.__renderTarget=S,!je.__hasExternalTextures){const ve=Math.max(1,S.width>>te),Ne=Math.max(1,S.height>>te);V===i.TEXTURE_3D||V===i.TEXTURE_2D_ARRAY?t.texImage3D(V,te,Te,ve,Ne,S.depth,0,Me,_e,null):t.texImage2D(V,te,Te,ve,Ne,0,Me,_e,null)}t.bindFramebuffer(i.FRAMEBUFFER,C),Qe(S)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,J,V,fe.__webglTexture,0,$e(S)):(V===i.TEXTURE_2D||V>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&V<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,J,V,fe.__webglTexture,te),t.bindFramebuffer(i.FRAMEBUFFER,null)}function oe(C,S,q){if(i.bindRenderbuffer(i.RENDERBUFFER,C),S.depthBuffer){const J=S.depthTexture,V=J&&J.isDepthTexture?J.type:null,te=M(S.stencilBuffer,V),Me=S.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,_e=$e(S);Qe(S)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,_e,te,S.width,S.height):q?i.renderbufferStorageMultisample(i.RENDERBUFFER,_e,te,S.width,S.height):i.renderbufferStorage(i.RENDERBUFFER,te,S.width,S.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,Me,i.RENDERBUFFER,C)}else{const J=S.textures;for(let V=0;V<J.length;V++){const te=J[V],Me=r.convert(te.format,te.colorSpace),_e=r.convert(te.type),Te=w(te.internalFormat,Me,_e,te.colorSpace),je=$e(S);q&&Qe(S)===!1?i.renderbufferStorageMultisample(i.RENDERBUFFER,je,Te,S.width,S.height):Qe(S)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,je,Te,S.width,S.height):i.renderbufferStorage(i.RENDERBUFFER,Te,S.width,S.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function ke(C,S){if(S&&S.isWebGLCubeRenderTarget)throw new Error("Depth Texture with cube render targets is not supported");if(t.bindFramebuffer(i.FRAMEBUFFER,C),!(S.depthTexture&&S.depthTexture.isDepthTexture))throw new Error("renderTarget.depthTexture must be an instance of THREE.DepthTexture");const J=n.get(S.depthTexture);J.__renderTarget=S,(!J.__webglTexture||S.depthTexture.image.width!==S.width||S.depthTexture.image.height!==S.height)&&(S.depthTexture.image.width=S.width,S.depthTexture.image.height=S.height,S.depthTexture.needsUpdate=!0),Z(S.depthTexture,0);const V=J.__webglTexture,te=$e(S);if(S.depthTexture.format===Er)Qe(S)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,i.DEPTH_ATTACHMENT,i.TEXTURE_2D,V,0,te):i.framebufferTexture2D(i.FRAMEBUFFER,i.DEPTH_ATTACHMENT,i.TEXTURE_2D,V,0);else if(S.depthTexture.format===Ir)Qe(S)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,i.DEPTH_STENCIL_ATTACHMENT,i.TEXTURE_2D,V,0,te):i.framebufferTexture2D(i.FRAMEBUFFER,i.DEPTH_STENCIL_ATTACHMENT,i.TEXTURE_2D,V,0);else throw new Error("Unknown depthTexture format")}function Ve(C){const S=n.get(C),q=C.isWebGLCubeRenderTarget===!0;if(S.__boundDepthTexture!==C.depthTexture){const J=C.depthTexture;if(S.__depthDisposeCallback&&S.__depthDisposeCallback(),J){const V=()=>{delete S.__boundDepthTexture,delete S.__depthDisposeCallback,J.removeEventListener("dispose",V)};J.addEventListener("dispose",V),S.__depthDisposeCallback=V}S.__boundDepthTexture=J}if(C.depthTexture&&!S.__autoAllocateDepthBuffer){if(q)throw new Error("target.depthTexture not supported in Cube render targets");ke(S.__webglFramebuffer,C)}else if(q){S.__webglDepthbuffer=[];for(let J=0;J<6;J++)if(t.bindFramebuffer(i.FRAMEBUFFER,S.__webglFramebuffer[J]),S.__webglDepthbuffer[J]===void 0)S.__webglDepthbuffer[J]=i.createRenderbuffer(),oe(S.__webglDepthbuffer[J],C,!1);else{const V=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,te=S.__webglDepthbuffer[J];i.bindRenderbuffer(i.RENDERBUFFER,te),i.framebufferRenderbuffer(i.FRAMEBUFFER,V,i.RENDERBUFFER,te)}}else if(t.bindFramebuffer(i.FRAMEBUFFER,S.__webglFramebuffer),S.__webglDepthbuffer===void 0)S.__webglDepthbuffer=i.createRenderbuffer(),oe(S.__webglDepthbuffer,C,!1);else{const J=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,V=S.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,V),i.framebufferRenderbuffer(i.FRAMEBUFFER,J,i.RENDERBUFFER,V)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function Ie(C,S,q){const J=n.get(C);S!==void 0&&ge(J.__webglFramebuffer,C,C.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),q!==void 0&&Ve(C)}function ot(C){const S=C.texture,q=n.get(C),J=n.get(S);C.addEventListener("dispose",L);const V=C.textures,te=C.isWebGLCubeRenderTarget===!0,Me=V.length>1;if(Me||(J.__webglTexture===void 0&&(J.__webglTexture=i.createTexture()),J.__version=S.version,o.memory.textures++),te){q.__webglFramebuffer=[];for(let _e=0;_e<6;_e++)if(S.mipmaps&&S.mipmaps.length>0){q.__webglFramebuffer[_e]=[];for(let Te=0;Te<S.mipmaps.length;Te++)q.__webglFramebuffer[_e][Te]=i.createFramebuffer()}else q.__webglFramebuffer[_e]=i.createFramebuffer()}else{if(S.mipmaps&&S.mipmaps.length>0){q.__webglFramebuffer=[];for(let _e=0;_e<S.mipmaps.length;_e++)q.__webglFramebuffer[_e]=i.createFramebuffer()}else q.__webglFramebuffer=i.createFramebuffer();if(Me)for(let _e=0,Te=V.length;_e<Te;_e++){const je=n.get(V[_e]);je.__webglTexture===void 0&&(je.__webglTexture=i.createTexture(),o.memory.textures++)}if(C.samples>0&&Qe(C)===!1){q.__webglMultisampledFramebuffer=i.createFramebuffer(),q.__webglColorRenderbuffer=[],t.bindFramebuffer(i.FRAMEBUFFER,q.__webglMultisampledFramebuffer);for(let _e=0;_e<V.length;_e++){const Te=V[_e];q.__webglColorRenderbuffer[_e]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,q.__webglColorRenderbuffer[_e]);const je=r.convert(Te.format,Te.colorSpace),fe=r.convert(Te.type),ve=w(Te.internalFormat,je,fe,Te.colorSpace,C.isXRRenderTarget===!0),Ne=$e(C);i.renderbufferStorageMultisample(i.RENDERBUFFER,Ne,ve,C.width,C.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+_e,i.RENDERBUFFER,q.__webglColorRenderbuffer[_e])}i.bindRenderbuffer(i.RENDERBUFFER,null),C.depthBuffer&&(q.__webglDepthRenderbuffer=i.createRenderbuffer(),oe(q.__webglDepthRenderbuffer,C,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(te){t.bindTexture(i.TEXTURE_CUBE_MAP,J.__webglTexture),Se(i.TEXTURE_CUBE_MAP,S);for(let _e=0;_e<6;_e++)if(S.mipmaps&&S.mipmaps.length>0)for(let Te=0;Te<S.mipmaps.length;Te++)ge(q.__webglFramebuffer[_e][Te],C,S,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+_e,Te);else ge(q.__webglFramebuffer[_e],C,S,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+_e,0);p(S)&&d(i.TEXTURE_CUBE_MAP),t.unbindTexture()}else if(Me){for(let _e=0,Te=V.length;_e<Te;_e++){const je=V[_e],fe=n.get(je);t.bindTexture(i.TEXTURE_2D,fe.__webglTexture),Se(i.TEXTURE_2D,je),ge(q.__webglFramebuffer,C,je,i.COLOR_ATTACHMENT0+_e,i.TEXTURE_2D,0),p(je)&&d(i.TEXTURE_2D)}t.unbindTexture()}else{let _e=i.TEXTURE_2D;if((C.isWebGL3DRenderTarget||C.isWebGLArrayRenderTarget)&&(_e=C.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(_e,J.__webglTexture),Se(_e,S),S.mipmaps&&S.mipmaps.length>0)for(let Te=0;Te<S.mipmaps.length;Te++)ge(q.__webglFramebuffer[Te],C,S,i.COLOR_ATTACHMENT0,_e,Te);else ge(q.__webglFramebuffer,C,S,i.COLOR_ATTACHMENT0,_e,0);p(S)&&d(_e),t.unbindTexture()}C.depthBuffer&&Ve(C)}function Ke(C){const S=C.textures;for(let q=0,J=S.length;q<J;q++){const V=S[q];if(p(V)){const te=b(C),Me=n.get(V).__webglTexture;t.bindTexture(te,Me),d(te),t.unbindTexture()}}}const at=[],k=[];function jt(C){if(C.samples>0){if(Qe(C)===!1){const S=C.textures,q=C.width,J=C.height;let V=i.COLOR_BUFFER_BIT;const te=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,Me=n.get(C),_e=S.length>1;if(_e)for(let Te=0;Te<S.length;Te++)t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+Te,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+Te,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,Me.__webglMultisampledFramebuffer),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,Me.__webglFramebuffer);for(let Te=0;Te<S.length;Te++){if(C.resolveDepthBuffer&&(C.depthBuffer&&(V|=i.DEPTH_BUFFER_BIT),C.stencilBuffer&&C.resolveStencilBuffer&&(V|=i.STENCIL_BUFFER_BIT)),_e){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,Me.__webglColorRenderbuffer[Te]);const je=n.get(S[Te]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,je,0)}i.blitFramebuffer(0,0,q,J,0,0,q,J,V,i.NEAREST),l===!0&&(at.length=0,k.length=0,at.push(i.COLOR_ATTACHMENT0+Te),C.depthBuffer&&C.resolveDepthBuffer===!1&&(at.push(te),k.push(te),i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,k)),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,at))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),_e)for(let Te=0;Te<S.length;Te++){t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+Te,i.RENDERBUFFER,Me.__webglColorRenderbuffer[Te]);const je=n.get(S[Te]).__webglTexture;t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+Te,i.TEXTURE_2D,je,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,Me.__webglMultisampledFramebuffer)}else if(C.depthBuffer&&C.resolveDepthBuffer===!1&&l){const S=C.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[S])}}}function $e(C){return Math.min(s.maxSamples,C.samples)}function Qe(C){const S=n.get(C);return C.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&S.__useRenderToTexture!==!1}function He(C){const S=o.render.frame;u.get(C)!==S&&(u.set(C,S),C.update())}function ct(C,S){const q=C.colorSpace,J=C.format,V=C.type;return C.isCompressedTexture===!0||C.isVideoTexture===!0||q!==zr&&q!==ls&&(ft.getTransfer(q)===Tt?(J!==mi||V!==Yi)&&console.warn("THREE.WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):console.error("THREE.WebGLTextures: Unsupported texture color space:",q)),S}function Pe(C){return typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement?(c.width=C.naturalWidth||C.width,c.height=C.naturalHeight||C.height):typeof VideoFrame<"u"&&C instanceof VideoFrame?(c.width=C.displayWidth,c.height=C.displayHeight):(c.width=C.width,c.height=C.height),c}this.allocateTextureUnit=F,this.resetTextureUnits=K,this.setTexture2D=Z,this.setTexture2DArray=j,this.setTexture3D=ee,this.setTextureCube=Q,this.rebindTextures=Ie,this.setupRenderTarget=ot,this.updateRenderTargetMipmap=Ke,this.updateMultisampleRenderTarget=jt,this.setupDepthRenderbuffer=Ve,this.setupFrameBufferTexture=ge,this.useMultisampledRTT=Qe}function oE(i,e){function t(n,s=ls){let r;const o=ft.getTransfer(s);if(n===Yi)return i.UNSIGNED_BYTE;if(n===_h)return i.UNSIGNED_SHORT_4_4_4_4;if(n===vh)return i.UNSIGNED_SHORT_5_5_5_1;if(n===dp)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===up)return i.BYTE;if(n===fp)return i.SHORT;if(n===vo)return i.UNSIGNED_SHORT;if(n===gh)return i.INT;if(n===Bs)return i.UNSIGNED_INT;if(n===zi)return i.FLOAT;if(n===Eo)return i.HALF_FLOAT;if(n===pp)return i.ALPHA;if(n===mp)return i.RGB;if(n===mi)return i.RGBA;if(n===gp)return i.LUMINANCE;if(n===_p)return i.LUMINANCE_ALPHA;if(n===Er)return i.DEPTH_COMPONENT;if(n===Ir)return i.DEPTH_STENCIL;if(n===vp)return i.RED;if(n===xh)return i.RED_INTEGER;if(n===xp)return i.RG;if(n===Sh)return i.RG_INTEGER;if(n===Mh)return i.RGBA_INTEGER;if(n===fa||n===da||n===pa||n===ma)if(o===Tt)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===fa)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===da)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===pa)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===ma)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===fa)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===da)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===pa)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===ma)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===Mc||n===yc||n===Ec||n===bc)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===Mc)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===yc)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Ec)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===bc)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===Tc||n===wc||n===Ac)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(n===Tc||n===wc)return o===Tt?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===Ac)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC}else return null;if(n===Cc||n===Rc||n===Pc||n===Dc||n===Lc||n===Uc||n===Ic||n===Nc||n===Fc||n===Oc||n===Bc||n===kc||n===zc||n===Vc)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(n===Cc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Rc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===Pc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Dc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===Lc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Uc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Ic)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Nc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Fc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===Oc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===Bc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===kc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===zc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Vc)return o===Tt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===ga||n===Hc||n===Gc)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(n===ga)return o===Tt?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===Hc)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Gc)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Sp||n===Wc||n===Xc||n===Yc)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(n===ga)return r.COMPRESSED_RED_RGTC1_EXT;if(n===Wc)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===Xc)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===Yc)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Ur?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}class aE extends ei{constructor(e=[]){super(),this.isArrayCamera=!0,this.cameras=e}}class cs extends An{constructor(){super(),this.isGroup=!0,this.type="Group"}}const lE={type:"move"};class Gl{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new cs,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new cs,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new H,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new H),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new cs,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new H,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new H),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){const t=this._hand;if(t)for(const n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let s=null,r=null,o=null;const a=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){o=!0;for(const v of e.hand.values()){const p=t.getJointPose(v,n),d=this._getHandJoint(c,v);p!==null&&(d.matrix.fromArray(p.transform.matrix),d.matrix.decompose(d.position,d.rotation,d.scale),d.matrixWorldNeedsUpdate=!0,d.jointRadius=p.radius),d.visible=p!==null}const u=c.joints["index-finger-tip"],h=c.joints["thumb-tip"],f=u.position.distanceTo(h.position),m=.02,_=.005;c.inputState.pinching&&f>m+_?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&f<=m-_&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.rotation,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1));a!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.rotation,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(lE)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){const n=new cs;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}}const cE=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,hE=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`;class uE{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t,n){if(this.texture===null){const s=new wn,r=e.properties.get(s);r.__webglTexture=t.texture,(t.depthNear!=n.depthNear||t.depthFar!=n.depthFar)&&(this.depthNear=t.depthNear,this.depthFar=t.depthFar),this.texture=s}}getMesh(e){if(this.texture!==null&&this.mesh===null){const t=e.cameras[0].viewport,n=new Ci({vertexShader:cE,fragmentShader:hE,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Ai(new Ao(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}}class fE extends Hs{constructor(e,t){super();const n=this;let s=null,r=1,o=null,a="local-floor",l=1,c=null,u=null,h=null,f=null,m=null,_=null;const v=new uE,p=t.getContextAttributes();let d=null,b=null;const w=[],M=[],B=new nt;let D=null;const L=new ei;L.viewport=new Gt;const U=new ei;U.viewport=new Gt;const T=[L,U],y=new aE;let R=null,K=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(ie){let ae=w[ie];return ae===void 0&&(ae=new Gl,w[ie]=ae),ae.getTargetRaySpace()},this.getControllerGrip=function(ie){let ae=w[ie];return ae===void 0&&(ae=new Gl,w[ie]=ae),ae.getGripSpace()},this.getHand=function(ie){let ae=w[ie];return ae===void 0&&(ae=new Gl,w[ie]=ae),ae.getHandSpace()};function F(ie){const ae=M.indexOf(ie.inputSource);if(ae===-1)return;const ge=w[ae];ge!==void 0&&(ge.update(ie.inputSource,ie.frame,c||o),ge.dispatchEvent({type:ie.type,data:ie.inputSource}))}function G(){s.removeEventListener("select",F),s.removeEventListener("selectstart",F),s.removeEventListener("selectend",F),s.removeEventListener("squeeze",F),s.removeEventListener("squeezestart",F),s.removeEventListener("squeezeend",F),s.removeEventListener("end",G),s.removeEventListener("inputsourceschange",Z);for(let ie=0;ie<w.length;ie++){const ae=M[ie];ae!==null&&(M[ie]=null,w[ie].disconnect(ae))}R=null,K=null,v.reset(),e.setRenderTarget(d),m=null,f=null,h=null,s=null,b=null,pe.stop(),n.isPresenting=!1,e.setPixelRatio(D),e.setSize(B.width,B.height,!1),n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(ie){r=ie,n.isPresenting===!0&&console.warn("THREE.WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(ie){a=ie,n.isPresenting===!0&&console.warn("THREE.WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(ie){c=ie},this.getBaseLayer=function(){return f!==null?f:m},this.getBinding=function(){return h},this.getFrame=function(){return _},this.getSession=function(){return s},this.setSession=async function(ie){if(s=ie,s!==null){if(d=e.getRenderTarget(),s.addEventListener("select",F),s.addEventListener("selectstart",F),s.addEventListener("selectend",F),s.addEventListener("squeeze",F),s.addEventListener("squeezestart",F),s.addEventListener("squeezeend",F),s.addEventListener("end",G),s.addEventListener("inputsourceschange",Z),p.xrCompatible!==!0&&await t.makeXRCompatible(),D=e.getPixelRatio(),e.getSize(B),s.renderState.layers===void 0){const ae={antialias:p.antialias,alpha:!0,depth:p.depth,stencil:p.stencil,framebufferScaleFactor:r};m=new XRWebGLLayer(s,t,ae),s.updateRenderState({baseLayer:m}),e.setPixelRatio(1),e.setSize(m.framebufferWidth,m.framebufferHeight,!1),b=new ks(m.framebufferWidth,m.framebufferHeight,{format:mi,type:Yi,colorSpace:e.outputColorSpace,stencilBuffer:p.stencil})}else{let ae=null,ge=null,oe=null;p.depth&&(oe=p.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,ae=p.stencil?Ir:Er,ge=p.stencil?Ur:Bs);const ke={colorFormat:t.RGBA8,depthFormat:oe,scaleFactor:r};h=new XRWebGLBinding(s,t),f=h.createProjectionLayer(ke),s.updateRenderState({layers:[f]}),e.setPixelRatio(1),e.setSize(f.textureWidth,f.textureHeight,!1),b=new ks(f.textureWidth,f.textureHeight,{format:mi,type:Yi,depthTexture:new Np(f.textureWidth,f.textureHeight,ge,void 0,void 0,void 0,void 0,void 0,void 0,ae),stencilBuffer:p.stencil,colorSpace:e.outputColorSpace,samples:p.antialias?4:0,resolveDepthBuffer:f.ignoreDepthValues===!1})}b.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),pe.setContext(s),pe.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return v.getDepthTexture()};function Z(ie){for(let ae=0;ae<ie.removed.length;ae++){const ge=ie.removed[ae],oe=M.indexOf(ge);oe>=0&&(M[oe]=null,w[oe].disconnect(ge))}for(let ae=0;ae<ie.added.length;ae++){const ge=ie.added[ae];let oe=M.indexOf(ge);if(oe===-1){for(let Ve=0;Ve<w.length;Ve++)if(Ve>=M.length){M.push(ge),oe=Ve;break}else if(M[Ve]===null){M[Ve]=ge,oe=Ve;break}if(oe===-1)break}const ke=w[oe];ke&&ke.connect(ge)}}const j=new H,ee=new H;function Q(ie,ae,ge){j.setFromMatrixPosition(ae.matrixWorld),ee.setFromMatrixPosition(ge.matrixWorld);const oe=j.distanceTo(ee),ke=ae.projectionMatrix.elements,Ve=ge.projectionMatrix.elements,Ie=ke[14]/(ke[10]-1),ot=ke[14]/(ke[10]+1),Ke=(ke[9]+1)/ke[5],at=(ke[9]-1)/ke[5],k=(ke[8]-1)/ke[0],jt=(Ve[8]+1)/Ve[0],$e=Ie*k,Qe=Ie*jt,He=oe/(-k+jt),ct=He*-k;if(ae.matrixWorld.decompose(ie.position,ie.quaternion,ie.scale),ie.translateX(ct),ie.translateZ(He),ie.matrixWorld.compose(ie.position,ie.quaternion,ie.scale),ie.matrixWorldInverse.copy(ie.matrixWorld).invert(),ke[10]===-1)ie.projectionMatrix.copy(ae.projectionMatrix),ie.projectionMatrixInverse.copy(ae.projectionMatrixInverse);else{const Pe=Ie+He,C=ot+He,S=$e-ct,q=Qe+(oe-ct),J=Ke*ot/C*Pe,V=at*ot/C*Pe;ie.projectionMatrix.makePerspective(S,q,J,V,Pe,C),ie.projectionMatrixInverse.copy(ie.projectionMatrix).invert()}}function ue(ie,ae){ae===null?ie.matrixWorld.copy(ie.matrix):ie.matrixWorld.multiplyMatrices(ae.matrixWorld,ie.matrix),ie.matrixWorldInverse.copy(ie.matrixWorld).invert()}this.updateCamera=function(ie){if(s===null)return;let ae=ie.near,ge=ie.far;v.texture!==null&&(v.depthNear>0&&(ae=v.depthNear),v.depthFar>0&&(ge=v.depthFar)),y.near=U.near=L.near=ae,y.far=U.far=L.far=ge,(R!==y.near||K!==y.far)&&(s.updateRenderState({depthNear:y.near,depthFar:y.far}),R=y.near,K=y.far),L.layers.mask=ie.layers.mask|2,U.layers.mask=ie.layers.mask|4,y.layers.mask=L.layers.mask|U.layers.mask;const oe=ie.parent,ke=y.cameras;ue(y,oe);for(let Ve=0;Ve<ke.length;Ve++)ue(ke[Ve],oe);ke.length===2?Q(y,L,U):y.projectionMatrix.copy(L.projectionMatrix),ce(ie,y,oe)};function ce(ie,ae,ge){ge===null?ie.matrix.copy(ae.matrixWorld):(ie.matrix.copy(ge.matrixWorld),ie.matrix.invert(),ie.matrix.multiply(ae.matrixWorld)),ie.matrix.decompose(ie.position,ie.quaternion,ie.scale),ie.updateMatrixWorld(!0),ie.projectionMatrix.copy(ae.projectionMatrix),ie.projectionMatrixInverse.copy(ae.projectionMatrixInverse),ie.isPerspectiveCamera&&(ie.fov=xo*2*Math.atan(1/ie.projectionMatrix.elements[5]),ie.zoom=1)}this.getCamera=function(){return y},this.getFoveation=function(){if(!(f===null&&m===null))return l},this.setFoveation=function(ie){l=ie,f!==null&&(f.fixedFoveation=ie),m!==null&&m.fixedFoveation!==void 0&&(m.fixedFoveation=ie)},this.hasDepthSensing=function(){return v.texture!==null},this.getDepthSensingMesh=function(){return v.getMesh(y)};let me=null;function Se(ie,ae){if(u=ae.getViewerPose(c||o),_=ae,u!==null){const ge=u.views;m!==null&&(e.setRenderTargetFramebuffer(b,m.framebuffer),e.setRenderTarget(b));let oe=!1;ge.length!==y.cameras.length&&(y.cameras.length=0,oe=!0);for(let Ve=0;Ve<ge.length;Ve++){const Ie=ge[Ve];let ot=null;if(m!==null)ot=m.getViewport(Ie);else{const at=h.getViewSubImage(f,Ie);ot=at.viewport,Ve===0&&(e.setRenderTargetTextures(b,at.colorTexture,f.ignoreDepthValues?void 0:at.depthStencilTexture),e.setRenderTarget(b))}let Ke=T[Ve];Ke===void 0&&(Ke=new ei,Ke.layers.enable(Ve),Ke.viewport=new Gt,T[Ve]=Ke),Ke.matrix.fromArray(Ie.transform.matrix),Ke.matrix.decompose(Ke.position,Ke.quaternion,Ke.scale),Ke.projectionMatrix.fromArray(Ie.projectionMatrix),Ke.projectionMatrixInverse.copy(Ke.projectionMatrix).invert(),Ke.viewport.set(ot.x,ot.y,ot.width,ot.height),Ve===0&&(y.matrix.copy(Ke.matrix),y.matrix.decompose(y.position,y.quaternion,y.scale)),oe===!0&&y.cameras.push(Ke)}const ke=s.enabledFeatures;if(ke&&ke.includes("depth-sensing")){const Ve=h.getDepthInformation(ge[0]);Ve&&Ve.isValid&&Ve.texture&&v.init(e,Ve,s.renderState)}}for(let ge=0;ge<w.length;ge++){const oe=M[ge],ke=w[ge];oe!==null&&ke!==void 0&&ke.update(oe,ae,c||o)}me&&me(ie,ae),ae.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:ae}),_=null}const pe=new Ip;pe.setAnimationLoop(Se),this.setAnimationLoop=function(ie){me=ie},this.dispose=function(){}}}const As=new qi,dE=new Nt;function pE(i,e){function t(p,d){p.matrixAutoUpdate===!0&&p.updateMatrix(),d.value.copy(p.matrix)}function n(p,d){d.color.getRGB(p.fogColor.value,Pp(i)),d.isFog?(p.fogNear.value=d.near,p.fogFar.value=d.far):d.isFogExp2&&(p.fogDensity.value=d.density)}function s(p,d,b,w,M){d.isMeshBasicMaterial||d.isMeshLambertMaterial?r(p,d):d.isMeshToonMaterial?(r(p,d),h(p,d)):d.isMeshPhongMaterial?(r(p,d),u(p,d)):d.isMeshStandardMaterial?(r(p,d),f(p,d),d.isMeshPhysicalMaterial&&m(p,d,M)):d.isMeshMatcapMaterial?(r(p,d),_(p,d)):d.isMeshDepthMaterial?r(p,d):d.isMeshDistanceMaterial?(r(p,d),v(p,d)):d.isMeshNormalMaterial?r(p,d):d.isLineBasicMaterial?(o(p,d),d.isLineDashedMaterial&&a(p,d)):d.isPointsMaterial?l(p,d,b,w):d.isSpriteMaterial?c(p,d):d.isShadowMaterial?(p.color.value.copy(d.color),p.opacity.value=d.opacity):d.isShaderMaterial&&(d.uniformsNeedUpdate=!1)}function r(p,d){p.opacity.value=d.opacity,d.color&&p.diffuse.value.copy(d.color),d.emissive&&p.emissive.value.copy(d.emissive).multiplyScalar(d.emissiveIntensity),d.map&&(p.map.value=d.map,t(d.map,p.mapTransform)),d.alphaMap&&(p.alphaMap.value=d.alphaMap,t(d.alphaMap,p.alphaMapTransform)),d.bumpMap&&(p.bumpMap.value=d.bumpMap,t(d.bumpMap,p.bumpMapTransform),p.bumpScale.value=d.bumpScale,d.side===Ln&&(p.bumpScale.value*=-1)),d.normalMap&&(p.normalMap.value=d.normalMap,t(d.normalMap,p.normalMapTransform),p.normalScale.value.copy(d.normalScale),d.side===Ln&&p.normalScale.value.negate()),d.displacementMap&&(p.displacementMap.value=d.displacementMap,t(d.displacementMap,p.displacementMapTransform),p.displacementScale.value=d.displacementScale,p.displacementBias.value=d.displacementBias),d.emissiveMap&&(p.emissiveMap.value=d.emissiveMap,t(d.emissiveMap,p.emissiveMapTransform)),d.specularMap&&(p.specularMap.value=d.specularMap,t(d.specularMap,p.specularMapTransform)),d.alphaTest>0&&(p.alphaTest.value=d.alphaTest);const b=e.get(d),w=b.envMap,M=b.envMapRotation;w&&(p.envMap.value=w,As.copy(M),As.x*=-1,As.y*=-1,As.z*=-1,w.isCubeTexture&&w.isRenderTargetTexture===!1&&(As.y*=-1,As.z*=-1),p.envMapRotation.value.setFromMatrix4(dE.makeRotationFromEuler(As)),p.flipEnvMap.value=w.isCubeTexture&&w.isRenderTargetTexture===!1?-1:1,p.reflectivity.value=d.reflectivity,p.ior.value=d.ior,p.refractionRatio.value=d.refractionRatio),d.lightMap&&(p.lightMap.value=d.lightMap,p.lightMapIntensity.value=d.lightMapIntensity,t(d.lightMap,p.lightMapTransform)),d.aoMap&&(p.aoMap.value=d.aoMap,p.aoMapIntensity.value=d.aoMapIntensity,t(d.aoMap,p.aoMapTransform))}function o(p,d){p.diffuse.value.copy(d.color),p.opacity.value=d.opacity,d.map&&(p.map.value=d.map,t(d.map,p.mapTransform))}function a(p,d){p.dashSize.value=d.dashSize,p.totalSize.value=d.dashSize+d.gapSize,p.scale.value=d.scale}function l(p,d,b,w){p.diffuse.value.copy(d.color),p.opacity.value=d.opacity,p.size.value=d.size*b,p.scale.value=w*.5,d.map&&(p.map.value=d.map,t(d.map,p.uvTransform)),d.alphaMap&&(p.alphaMap.value=d.alphaMap,t(d.alphaMap,p.alphaMapTransform)),d.alphaTest>0&&(p.alphaTest.value=d.alphaTest)}function c(p,d){p.diffuse.value.copy(d.color),p.opacity.value=d.opacity,p.rotation.value=d.rotation,d.map&&(p.map.value=d.map,t(d.map,p.mapTransform)),d.alphaMap&&(p.alphaMap.value=d.alphaMap,t(d.alphaMap,p.alphaMapTransform)),d.alphaTest>0&&(p.alphaTest.value=d.alphaTest)}function u(p,d){p.specular.value.copy(d.specular),p.shininess.value=Math.max(d.shininess,1e-4)}function h(p,d){d.gradientMap&&(p.gradientMap.value=d.gradientMap)}function f(p,d){p.metalness.value=d.metalness,d.metalnessMap&&(p.metalnessMap.value=d.metalnessMap,t(d.metalnessMap,p.metalnessMapTransform)),p.roughness.value=d.roughness,d.roughnessMap&&(p.roughnessMap.value=d.roughnessMap,t(d.roughnessMap,p.roughnessMapTransform)),d.envMap&&(p.envMapIntensity.value=d.envMapIntensity)}function m(p,d,b){p.ior.value=d.ior,d.sheen>0&&(p.sheenColor.value.copy(d.sheenColor).multiplyScalar(d.sheen),p.sheenRoughness.value=d.sheenRoughness,d.sheenColorMap&&(p.sheenColorMap.value=d.sheenColorMap,t(d.sheenColorMap,p.sheenColorMapTransform)),d.sheenRoughnessMap&&(p.sheenRoughnessMap.value=d.sheenRoughnessMap,t(d.sheenRoughnessMap,p.sheenRoughnessMapTransform))),d.clearcoat>0&&(p.clearcoat.value=d.clearcoat,p.clearcoatRoughness.value=d.clearcoatRoughness,d.clearcoatMap&&(p.clearcoatMap.value=d.clearcoatMap,t(d.clearcoatMap,p.clearcoatMapTransform)),d.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=d.clearcoatRoughnessMap,t(d.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),d.clearcoatNormalMap&&(p.clearcoatNormalMap.value=d.clearcoatNormalMap,t(d.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(d.clearcoatNormalScale),d.side===Ln&&p.clearcoatNormalScale.value.negate())),d.dispersion>0&&(p.dispersion.value=d.dispersion),d.iridescence>0&&(p.iridescence.value=d.iridescence,p.iridescenceIOR.value=d.iridescenceIOR,p.iridescenceThicknessMinimum.value=d.iridescenceThicknessRange[0],p.iridescenceThicknessMaximum.value=d.iridescenceThicknessRange[1],d.iridescenceMap&&(p.iridescenceMap.value=d.iridescenceMap,t(d.iridescenceMap,p.iridescenceMapTransform)),d.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=d.iridescenceThicknessMap,t(d.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),d.transmission>0&&(p.transmission.value=d.transmission,p.transmissionSamplerMap.value=b.texture,p.transmissionSamplerSize.value.set(b.width,b.height),d.transmissionMap&&(p.transmissionMap.value=d.transmissionMap,t(d.transmissionMap,p.transmissionMapTransform)),p.thickness.value=d.thickness,d.thicknessMap&&(p.thicknessMap.value=d.thicknessMap,t(d.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=d.attenuationDistance,p.attenuationColor.value.copy(d.attenuationColor)),d.anisotropy>0&&(p.anisotropyVector.value.set(d.anisotropy*Math.cos(d.anisotropyRotation),d.anisotropy*Math.sin(d.anisotropyRotation)),d.anisotropyMap&&(p.anisotropyMap.value=d.anisotropyMap,t(d.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=d.specularIntensity,p.specularColor.value.copy(d.specularColor),d.specularColorMap&&(p.specularColorMap.value=d.specularColorMap,t(d.specularColorMap,p.specularColorMapTransform)),d.specularIntensityMap&&(p.specularIntensityMap.value=d.specularIntensityMap,t(d.specularIntensityMap,p.specularIntensityMapTransform))}function _(p,d){d.matcap&&(p.matcap.value=d.matcap)}function v(p,d){const b=e.get(d).light;p.referencePosition.value.setFromMatrixPosition(b.matrixWorld),p.nearDistance.value=b.shadow.camera.near,p.farDistance.value=b.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function mE(i,e,t,n){let s={},r={},o=[];const a=i.getParameter(i.MAX_UNIFORM_BUFFER_BINDINGS);function l(b,w){const M=w.program;n.uniformBlockBinding(b,M)}function c(b,w){let M=s[b.id];M===void 0&&(_(b),M=u(b),s[b.id]=M,b.addEventListener("dispose",p));const B=w.program;n.updateUBOMapping(b,B);const D=e.render.frame;r[b.id]!==D&&(f(b),r[b.id]=D)}function u(b){const w=h();b.__bindingPointIndex=w;const M=i.createBuffer(),B=b.__size,D=b.usage;return i.bindBuffer(i.UNIFORM_BUFFER,M),i.bufferData(i.UNIFORM_BUFFER,B,D),i.bindBuffer(i.UNIFORM_BUFFER,null),i.bindBufferBase(i.UNIFORM_BUFFER,w,M),M}function h(){for(let b=0;b<a;b++)if(o.indexOf(b)===-1)return o.push(b),b;return console.error("THREE.WebGLRenderer: Maximum number of simultaneously usable uniforms groups reached."),0}function f(b){const w=s[b.id],M=b.uniforms,B=b.__cache;i.bindBuffer(i.UNIFORM_BUFFER,w);for(let D=0,L=M.length;D<L;D++){const U=Array.isArray(M[D])?M[D]:[M[D]];for(let T=0,y=U.length;T<y;T++){const R=U[T];if(m(R,D,T,B)===!0){const K=R.__offset,F=Array.isArray(R.value)?R.value:[R.value];let G=0;for(let Z=0;Z<F.length;Z++){const j=F[Z],ee=v(j);typeof j=="number"||typeof j=="boolean"?(R.__data[0]=j,i.bufferSubData(i.UNIFORM_BUFFER,K+G,R.__data)):j.isMatrix3?(R.__data[0]=j.elements[0],R.__data[1]=j.elements[1],R.__data[2]=j.elements[2],R.__data[3]=0,R.__data[4]=j.elements[3],R.__data[5]=j.elements[4],R.__data[6]=j.elements[5],R.__data[7]=0,R.__data[8]=j.elements[6],R.__data[9]=j.elements[7],R.__data[10]=j.elements[8],R.__data[11]=0):(j.toArray(R.__data,G),G+=ee.storage/Float32Array.BYTES_PER_ELEMENT)}i.bufferSubData(i.UNIFORM_BUFFER,K,R.__data)}}}i.bindBuffer(i.UNIFORM_BUFFER,null)}function m(b,w,M,B){const D=b.value,L=w+"_"+M;if(B[L]===void 0)return typeof D=="number"||typeof D=="boolean"?B[L]=D:B[L]=D.clone(),!0;{const U=B[L];if(typeof D=="number"||typeof D=="boolean"){if(U!==D)return B[L]=D,!0}else if(U.equals(D)===!1)return U.copy(D),!0}return!1}function _(b){const w=b.uniforms;let M=0;const B=16;for(let L=0,U=w.length;L<U;L++){const T=Array.isArray(w[L])?w[L]:[w[L]];for(let y=0,R=T.length;y<R;y++){const K=T[y],F=Array.isArray(K.value)?K.value:[K.value];for(let G=0,Z=F.length;G<Z;G++){const j=F[G],ee=v(j),Q=M%B,ue=Q%ee.boundary,ce=Q+ue;M+=ue,ce!==0&&B-ce<ee.storage&&(M+=B-ce),K.__data=new Float32Array(ee.storage/Float32Array.BYTES_PER_ELEMENT),K.__offset=M,M+=ee.storage}}}const D=M%B;return D>0&&(M+=B-D),b.__size=M,b.__cache={},this}function v(b){const w={boundary:0,storage:0};return typeof b=="number"||typeof b=="boolean"?(w.boundary=4,w.storage=4):b.isVector2?(w.boundary=8,w.storage=8):b.isVector3||b.isColor?(w.boundary=16,w.storage=12):b.isVector4?(w.boundary=16,w.storage=16):b.isMatrix3?(w.boundary=48,w.storage=48):b.isMatrix4?(w.boundary=64,w.storage=64):b.isTexture?console.warn("THREE.WebGLRenderer: Texture samplers can not be part of an uniforms group."):console.warn("THREE.WebGLRenderer: Unsupported uniform value type.",b),w}function p(b){const w=b.target;w.removeEventListener("dispose",p);const M=o.indexOf(w.__bindingPointIndex);o.splice(M,1),i.deleteBuffer(s[w.id]),delete s[w.id],delete r[w.id]}function d(){for(const b in s)i.deleteBuffer(s[b]);o=[],s={},r={}}return{bind:l,update:c,dispose:d}}class gE{constructor(e={}){const{canvas:t=iv(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:u="default",failIfMajorPerformanceCaveat:h=!1,reverseDepthBuffer:f=!1}=e;this.isWebGLRenderer=!0;let m;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");m=n.getContextAttributes().alpha}else m=o;const _=new Uint32Array(4),v=new Int32Array(4);let p=null,d=null;const b=[],w=[];this.domElement=t,this.debug={checkShaderErrors:!0,onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this._outputColorSpace=Gn,this.toneMapping=us,this.toneMappingExposure=1;const M=this;let B=!1,D=0,L=0,U=null,T=-1,y=null;const R=new Gt,K=new Gt;let F=null;const G=new xt(0);let Z=0,j=t.width,ee=t.height,Q=1,ue=null,ce=null;const me=new Gt(0,0,j,ee),Se=new Gt(0,0,j,ee);let pe=!1;const ie=new Up;let ae=!1,ge=!1;const oe=new Nt,ke=new Nt,Ve=new H,Ie=new Gt,ot={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0};let Ke=!1;function at(){return U===null?Q:1}let k=n;function jt(E,N){return t.getContext(E,N)}try{const E={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:u,failIfMajorPerformanceCaveat:h};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${mh}`),t.addEventListener("webglcontextlost",re,!1),t.addEventListener("webglcontextrestored",we,!1),t.addEventListener("webglcontextcreationerror",Ae,!1),k===null){const N="webgl2";if(k=jt(N,E),k===null)throw jt(N)?new Error("Error creating WebGL context with your selected attributes."):new Error("Error creating WebGL context.")}}catch(E){throw console.error("THREE.WebGLRenderer: "+E.message),E}let $e,Qe,He,ct,Pe,C,S,q,J,V,te,Me,_e,Te,je,fe,ve,Ne,Oe,Ee,tt,Ye,ht,O;function xe(){$e=new MM(k),$e.init(),Ye=new oE(k,$e),Qe=new pM(k,$e,e,Ye),He=new iE(k,$e),Qe.reverseDepthBuffer&&f&&He.buffers.depth.setReversed(!0),ct=new bM(k),Pe=new Hy,C=new rE(k,$e,He,Pe,Qe,Ye,ct),S=new gM(M),q=new SM(M),J=new Pv(k),ht=new fM(k,J),V=new yM(k,J,ct,ht),te=new wM(k,V,J,ct),Oe=new TM(k,Qe,C),fe=new mM(Pe),Me=new Vy(M,S,q,$e,Qe,ht,fe),_e=new pE(M,Pe),Te=new Wy,je=new Zy($e),Ne=new uM(M,S,q,He,te,m,l),ve=new tE(M,te,Qe),O=new mE(k,ct,Qe,He),Ee=new dM(k,$e,ct),tt=new EM(k,$e,ct),ct.programs=Me.programs,M.capabilities=Qe,M.extensions=$e,M.properties=Pe,M.renderLists=Te,M.shadowMap=ve,M.state=He,M.info=ct}xe();const ne=new fE(M,k);this.xr=ne,this.getContext=function(){return k},this.getContextAttributes=function(){return k.getContextAttributes()},this.forceContextLoss=function(){const E=$e.get("WEBGL_lose_context");E&&E.loseContext()},this.forceContextRestore=function(){const E=$e.get("WEBGL_lose_context");E&&E.restoreContext()},this.getPixelRatio=function(){return Q},this.setPixelRatio=function(E){E!==void 0&&(Q=E,this.setSize(j,ee,!1))},this.getSize=function(E){return E.set(j,ee)},this.setSize=function(E,N,W=!0){if(ne.isPresenting){console.warn("THREE.WebGLRenderer: Can't change size while VR device is presenting.");return}j=E,ee=N,t.width=Math.floor(E*Q),t.height=Math.floor(N*Q),W===!0&&(t.style.width=E+"px",t.style.height=N+"px"),this.setViewport(0,0,E,N)},this.getDrawingBufferSize=function(E){return E.set(j*Q,ee*Q).floor()},this.setDrawingBufferSize=function(E,N,W){j=E,ee=N,Q=W,t.width=Math.floor(E*W),t.height=Math.floor(N*W),this.setViewport(0,0,E,N)},this.getCurrentViewport=function(E){return E.copy(R)},this.getViewport=function(E){return E.copy(me)},this.setViewport=function(E,N,W,X){E.isVector4?me.set(E.x,E.y,E.z,E.w):me.set(E,N,W,X),He.viewport(R.copy(me).multiplyScalar(Q).round())},this.getScissor=function(E){return E.copy(Se)},this.setScissor=function(E,N,W,X){E.isVector4?Se.set(E.x,E.y,E.z,E.w):Se.set(E,N,W,X),He.scissor(K.copy(Se).multiplyScalar(Q).round())},this.getScissorTest=function(){return pe},this.setScissorTest=function(E){He.setScissorTest(pe=E)},this.setOpaqueSort=function(E){ue=E},this.setTransparentSort=function(E){ce=E},this.getClearColor=function(E){return E.copy(Ne.getClearColor())},this.setClearColor=function(){Ne.setClearColor.apply(Ne,arguments)},this.getClearAlpha=function(){return Ne.getClearAlpha()},this.setClearAlpha=function(){Ne.setClearAlpha.apply(Ne,arguments)},this.clear=function(E=!0,N=!0,W=!0){let X=0;if(E){let z=!1;if(U!==null){const he=U.texture.format;z=he===Mh||he===Sh||he===xh}if(z){const he=U.texture.type,ye=he===Yi||he===Bs||he===vo||he===Ur||he===_h||he===vh,Fe=Ne.getClearColor(),Le=Ne.getClearAlpha(),Ge=Fe.r,Xe=Fe.g,Ue=Fe.b;ye?(_[0]=Ge,_[1]=Xe,_[2]=Ue,_[3]=Le,k.clearBufferuiv(k.COLOR,0,_)):(v[0]=Ge,v[1]=Xe,v[2]=Ue,v[3]=Le,k.clearBufferiv(k.COLOR,0,v))}else X|=k.COLOR_BUFFER_BIT}N&&(X|=k.DEPTH_BUFFER_BIT),W&&(X|=k.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),k.clear(X)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.dispose=function(){t.removeEventListener("webglcontextlost",re,!1),t.removeEventListener("webglcontextrestored",we,!1),t.removeEventListener("webglcontextcreationerror",Ae,!1),Te.dispose(),je.dispose(),Pe.dispose(),S.dispose(),q.dispose(),te.dispose(),ht.dispose(),O.dispose(),Me.dispose(),ne.dispose(),ne.removeEventListener("sessionstart",Un),ne.removeEventListener("sessionend",Ri),Rn.stop()};function re(E){E.preventDefault(),console.log("THREE.WebGLRenderer: Context Lost."),B=!0}function we(){console.log("THREE.WebGLRenderer: Context Restored."),B=!1;const E=ct.autoReset,N=ve.enabled,W=ve.autoUpdate,X=ve.needsUpdate,z=ve.type;xe(),ct.autoReset=E,ve.enabled=N,ve.autoUpdate=W,ve.needsUpdate=X,ve.type=z}function Ae(E){console.error("THREE.WebGLRenderer: A WebGL context could not be created. Reason: ",E.statusMessage)}function Ze(E){const N=E.target;N.removeEventListener("dispose",Ze),Ft(N)}function Ft(E){nn(E),Pe.remove(E)}function nn(E){const N=Pe.get(E).programs;N!==void 0&&(N.forEach(function(W){Me.releaseProgram(W)}),E.isShaderMaterial&&Me.releaseShaderCache(E))}this.renderBufferDirect=function(E,N,W,X,z,he){N===null&&(N=ot);const ye=z.isMesh&&z.matrixWorld.determinant()<0,Fe=Xa(E,N,W,X,z);He.setMaterial(X,ye);let Le=W.index,Ge=1;if(X.wireframe===!0){if(Le=V.getWireframeAttribute(W),Le===void 0)return;Ge=2}const Xe=W.drawRange,Ue=W.attributes.position;let st=Xe.start*Ge,St=(Xe.start+Xe.count)*Ge;he!==null&&(st=Math.max(st,he.start*Ge),St=Math.min(St,(he.start+he.count)*Ge)),Le!==null?(st=Math.max(st,0),St=Math.min(St,Le.count)):Ue!=null&&(st=Math.max(st,0),St=Math.min(St,Ue.count));const yt=St-st;if(yt<0||yt===1/0)return;ht.setup(z,X,Fe,W,Le);let sn,lt=Ee;if(Le!==null&&(sn=J.get(Le),lt=tt,lt.setIndex(sn)),z.isMesh)X.wireframe===!0?(He.setLineWidth(X.wireframeLinewidth*at()),lt.setMode(k.LINES)):lt.setMode(k.TRIANGLES);else if(z.isLine){let Be=X.linewidth;Be===void 0&&(Be=1),He.setLineWidth(Be*at()),z.isLineSegments?lt.setMode(k.LINES):z.isLineLoop?lt.setMode(k.LINE_LOOP):lt.setMode(k.LINE_STRIP)}else z.isPoints?lt.setMode(k.POINTS):z.isSprite&&lt.setMode(k.TRIANGLES);if(z.isBatchedMesh)if(z._multiDrawInstances!==null)lt.renderMultiDrawInstances(z._multiDrawStarts,z._multiDrawCounts,z._multiDrawCount,z._multiDrawInstances);else if($e.get("WEBGL_multi_draw"))lt.renderMultiDraw(z._multiDrawStarts,z._multiDrawCounts,z._multiDrawCount);else{const Be=z._multiDrawStarts,Ot=z._multiDrawCounts,ut=z._multiDrawCount,Pn=Le?J.get(Le).bytesPerElement:1,vi=Pe.get(X).currentProgram.getUniforms();for(let fn=0;fn<ut;fn++)vi.setValue(k,"_gl_DrawID",fn),lt.render(Be[fn]/Pn,Ot[fn])}else if(z.isInstancedMesh)lt.renderInstances(st,yt,z.count);else if(W.isInstancedBufferGeometry){const Be=W._maxInstanceCount!==void 0?W._maxInstanceCount:1/0,Ot=Math.min(W.instanceCount,Be);lt.renderInstances(st,yt,Ot)}else lt.render(st,yt)};function gt(E,N,W){E.transparent===!0&&E.side===ki&&E.forceSinglePass===!1?(E.side=Ln,E.needsUpdate=!0,Gs(E,N,W),E.side=ps,E.needsUpdate=!0,Gs(E,N,W),E.side=ki):Gs(E,N,W)}this.compile=function(E,N,W=null){W===null&&(W=E),d=je.get(W),d.init(N),w.push(d),W.traverseVisible(function(z){z.isLight&&z.layers.test(N.layers)&&(d.pushLight(z),z.castShadow&&d.pushShadow(z))}),E!==W&&E.traverseVisible(function(z){z.isLight&&z.layers.test(N.layers)&&(d.pushLight(z),z.castShadow&&d.pushShadow(z))}),d.setupLights();const X=new Set;return E.traverse(function(z){if(!(z.isMesh||z.isPoints||z.isLine||z.isSprite))return;const he=z.material;if(he)if(Array.isArray(he))for(let ye=0;ye<he.length;ye++){const Fe=he[ye];gt(Fe,W,z),X.add(Fe)}else gt(he,W,z),X.add(he)}),w.pop(),d=null,X},this.compileAsync=function(E,N,W=null){const X=this.compile(E,N,W);return new Promise(z=>{function he(){if(X.forEach(function(ye){Pe.get(ye).currentProgram.isReady()&&X.delete(ye)}),X.size===0){z(E);return}setTimeout(he,10)}$e.get("KHR_parallel_shader_compile")!==null?he():setTimeout(he,10)})};let Kt=null;function Pt(E){Kt&&Kt(E)}function Un(){Rn.stop()}function Ri(){Rn.start()}const Rn=new Ip;Rn.setAnimationLoop(Pt),typeof self<"u"&&Rn.setContext(self),this.setAnimationLoop=function(E){Kt=E,ne.setAnimationLoop(E),E===null?Rn.stop():Rn.start()},ne.addEventListener("sessionstart",Un),ne.addEventListener("sessionend",Ri),this.render=function(E,N){if(N!==void 0&&N.isCamera!==!0){console.error("THREE.WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(B===!0)return;if(E.matrixWorldAutoUpdate===!0&&E.updateMatrixWorld(),N.parent===null&&N.matrixWorldAutoUpdate===!0&&N.updateMatrixWorld(),ne.enabled===!0&&ne.isPresenting===!0&&(ne.cameraAutoUpdate===!0&&ne.updateCamera(N),N=ne.getCamera()),E.isScene===!0&&E.onBeforeRender(M,E,N,U),d=je.get(E,w.length),d.init(N),w.push(d),ke.multiplyMatrices(N.projectionMatrix,N.matrixWorldInverse),ie.setFromProjectionMatrix(ke),ge=this.localClippingEnabled,ae=fe.init(this.clippingPlanes,ge),p=Te.get(E,b.length),p.init(),b.push(p),ne.enabled===!0&&ne.isPresenting===!0){const he=M.xr.getDepthSensingMesh();he!==null&&un(he,N,-1/0,M.sortObjects)}un(E,N,0,M.sortObjects),p.finish(),M.sortObjects===!0&&p.sort(ue,ce),Ke=ne.enabled===!1||ne.isPresenting===!1||ne.hasDepthSensing()===!1,Ke&&Ne.addToRenderList(p,E),this.info.render.frame++,ae===!0&&fe.beginShadows();const W=d.state.shadowsArray;ve.render(W,E,N),ae===!0&&fe.endShadows(),this.info.autoReset===!0&&this.info.reset();const X=p.opaque,z=p.transmissive;if(d.setupLights(),N.isArrayCamera){const he=N.cameras;if(z.length>0)for(let ye=0,Fe=he.length;ye<Fe;ye++){const Le=he[ye];Di(X,z,E,Le)}Ke&&Ne.render(E);for(let ye=0,Fe=he.length;ye<Fe;ye++){const Le=he[ye];Pi(p,E,Le,Le.viewport)}}else z.length>0&&Di(X,z,E,N),Ke&&Ne.render(E),Pi(p,E,N);U!==null&&(C.updateMultisampleRenderTarget(U),C.updateRenderTargetMipmap(U)),E.isScene===!0&&E.onAfterRender(M,E,N),ht.resetDefaultState(),T=-1,y=null,w.pop(),w.length>0?(d=w[w.length-1],ae===!0&&fe.setGlobalState(M.clippingPlanes,d.state.camera)):d=null,b.pop(),b.length>0?p=b[b.length-1]:p=null};function un(E,N,W,X){if(E.visible===!1)return;if(E.layers.test(N.layers)){if(E.isGroup)W=E.renderOrder;else if(E.isLOD)E.autoUpdate===!0&&E.update(N);else if(E.isLight)d.pushLight(E),E.castShadow&&d.pushShadow(E);else if(E.isSprite){if(!E.frustumCulled||ie.intersectsSprite(E)){X&&Ie.setFromMatrixPosition(E.matrixWorld).applyMatrix4(ke);const ye=te.update(E),Fe=E.material;Fe.visible&&p.push(E,ye,Fe,W,Ie.z,null)}}else if((E.isMesh||E.isLine||E.isPoints)&&(!E.frustumCulled||ie.intersectsObject(E))){const ye=te.update(E),Fe=E.material;if(X&&(E.boundingSphere!==void 0?(E.boundingSphere===null&&E.computeBoundingSphere(),Ie.copy(E.boundingSphere.center)):(ye.boundingSphere===null&&ye.computeBoundingSphere(),Ie.copy(ye.boundingSphere.center)),Ie.applyMatrix4(E.matrixWorld).applyMatrix4(ke)),Array.isArray(Fe)){const Le=ye.groups;for(let Ge=0,Xe=Le.length;Ge<Xe;Ge++){const Ue=Le[Ge],st=Fe[Ue.materialIndex];st&&st.visible&&p.push(E,ye,st,W,Ie.z,Ue)}}else Fe.visible&&p.push(E,ye,Fe,W,Ie.z,null)}}const he=E.children;for(let ye=0,Fe=he.length;ye<Fe;ye++)un(he[ye],N,W,X)}function Pi(E,N,W,X){const z=E.opaque,he=E.transmissive,ye=E.transparent;d.setupLightsView(W),ae===!0&&fe.setGlobalState(M.clippingPlanes,W),X&&He.viewport(R.copy(X)),z.length>0&&gs(z,N,W),he.length>0&&gs(he,N,W),ye.length>0&&gs(ye,N,W),He.buffers.depth.setTest(!0),He.buffers.depth.setMask(!0),He.buffers.color.setMask(!0),He.setPolygonOffset(!1)}function Di(E,N,W,X){if((W.isScene===!0?W.overrideMaterial:null)!==null)return;d.state.transmissionRenderTarget[X.id]===void 0&&(d.state.transmissionRenderTarget[X.id]=new ks(1,1,{generateMipmaps:!0,type:$e.has("EXT_color_buffer_half_float")||$e.has("EXT_color_buffer_float")?Eo:Yi,minFilter:Ns,samples:4,stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,colorSpace:ft.workingColorSpace}));const he=d.state.transmissionRenderTarget[X.id],ye=X.viewport||R;he.setSize(ye.z,ye.w);const Fe=M.getRenderTarget();M.setRenderTarget(he),M.getClearColor(G),Z=M.getClearAlpha(),Z<1&&M.setClearColor(16777215,.5),M.clear(),Ke&&Ne.render(W);const Le=M.toneMapping;M.toneMapping=us;const Ge=X.viewport;if(X.viewport!==void 0&&(X.viewport=void 0),d.setupLightsView(X),ae===!0&&fe.setGlobalState(M.clippingPlanes,X),gs(E,W,X),C.updateMultisampleRenderTarget(he),C.updateRenderTargetMipmap(he),$e.has("WEBGL_multisampled_render_to_texture")===!1){let Xe=!1;for(let Ue=0,st=N.length;Ue<st;Ue++){const St=N[Ue],yt=St.object,sn=St.geometry,lt=St.material,Be=St.group;if(lt.side===ki&&yt.layers.test(X.layers)){const Ot=lt.side;lt.side=Ln,lt.needsUpdate=!0,Wr(yt,W,X,sn,lt,Be),lt.side=Ot,lt.needsUpdate=!0,Xe=!0}}Xe===!0&&(C.updateMultisampleRenderTarget(he),C.updateRenderTargetMipmap(he))}M.setRenderTarget(Fe),M.setClearColor(G,Z),Ge!==void 0&&(X.viewport=Ge),M.toneMapping=Le}function gs(E,N,W){const X=N.isScene===!0?N.overrideMaterial:null;for(let z=0,he=E.length;z<he;z++){const ye=E[z],Fe=ye.object,Le=ye.geometry,Ge=X===null?ye.material:X,Xe=ye.group;Fe.layers.test(W.layers)&&Wr(Fe,N,W,Le,Ge,Xe)}}function Wr(E,N,W,X,z,he){E.onBeforeRender(M,N,W,X,z,he),E.modelViewMatrix.multiplyMatrices(W.matrixWorldInverse,E.matrixWorld),E.normalMatrix.getNormalMatrix(E.modelViewMatrix),z.onBeforeRender(M,N,W,X,E,he),z.transparent===!0&&z.side===ki&&z.forceSinglePass===!1?(z.side=Ln,z.needsUpdate=!0,M.renderBufferDirect(W,N,X,z,E,he),z.side=ps,z.needsUpdate=!0,M.renderBufferDirect(W,N,X,z,E,he),z.side=ki):M.renderBufferDirect(W,N,X,z,E,he),E.onAfterRender(M,N,W,X,z,he)}function Gs(E,N,W){N.isScene!==!0&&(N=ot);const X=Pe.get(E),z=d.state.lights,he=d.state.shadowsArray,ye=z.state.version,Fe=Me.getParameters(E,z.state,he,N,W),Le=Me.getProgramCacheKey(Fe);let Ge=X.programs;X.environment=E.isMeshStandardMaterial?N.environment:null,X.fog=N.fog,X.envMap=(E.isMeshStandardMaterial?q:S).get(E.envMap||X.environment),X.envMapRotation=X.environment!==null&&E.envMap===null?N.environmentRotation:E.envMapRotation,Ge===void 0&&(E.addEventListener("dispose",Ze),Ge=new Map,X.programs=Ge);let Xe=Ge.get(Le);if(Xe!==void 0){if(X.currentProgram===Xe&&X.lightsStateVersion===ye)return _i(E,Fe),Xe}else Fe.uniforms=Me.getUniforms(E),E.onBeforeCompile(Fe,M),Xe=Me.acquireProgram(Fe,Le),Ge.set(Le,Xe),X.uniforms=Fe.uniforms;const Ue=X.uniforms;return(!E.isShaderMaterial&&!E.isRawShaderMaterial||E.clipping===!0)&&(Ue.clippingPlanes=fe.uniform),_i(E,Fe),X.needsLights=Ro(E),X.lightsStateVersion=ye,X.needsLights&&(Ue.ambientLightColor.value=z.state.ambient,Ue.lightProbe.value=z.state.probe,Ue.directionalLights.value=z.state.directional,Ue.directionalLightShadows.value=z.state.directionalShadow,Ue.spotLights.value=z.state.spot,Ue.spotLightShadows.value=z.state.spotShadow,Ue.rectAreaLights.value=z.state.rectArea,Ue.ltc_1.value=z.state.rectAreaLTC1,Ue.ltc_2.value=z.state.rectAreaLTC2,Ue.pointLights.value=z.state.point,Ue.pointLightShadows.value=z.state.pointShadow,Ue.hemisphereLights.value=z.state.hemi,Ue.directionalShadowMap.value=z.state.directionalShadowMap,Ue.directionalShadowMatrix.value=z.state.directionalShadowMatrix,Ue.spotShadowMap.value=z.state.spotShadowMap,Ue.spotLightMatrix.value=z.state.spotLightMatrix,Ue.spotLightMap.value=z.state.spotLightMap,Ue.pointShadowMap.value=z.state.pointShadowMap,Ue.pointShadowMatrix.value=z.state.pointShadowMatrix),X.currentProgram=Xe,X.uniformsList=null,Xe}function Co(E){if(E.uniformsList===null){const N=E.currentProgram.getUniforms();E.uniformsList=_a.seqWithValue(N.seq,E.uniforms)}return E.uniformsList}function _i(E,N){const W=Pe.get(E);W.outputColorSpace=N.outputColorSpace,W.batching=N.batching,W.batchingColor=N.batchingColor,W.instancing=N.instancing,W.instancingColor=N.instancingColor,W.instancingMorph=N.instancingMorph,W.skinning=N.skinning,W.morphTargets=N.morphTargets,W.morphNormals=N.morphNormals,W.morphColors=N.morphColors,W.morphTargetsCount=N.morphTargetsCount,W.numClippingPlanes=N.numClippingPlanes,W.numIntersection=N.numClipIntersection,W.vertexAlphas=N.vertexAlphas,W.vertexTangents=N.vertexTangents,W.toneMapping=N.toneMapping}function Xa(E,N,W,X,z){N.isScene!==!0&&(N=ot),C.resetTextureUnits();const he=N.fog,ye=X.isMeshStandardMaterial?N.environment:null,Fe=U===null?M.outputColorSpace:U.isXRRenderTarget===!0?U.texture.colorSpace:zr,Le=(X.isMeshStandardMaterial?q:S).get(X.envMap||ye),Ge=X.vertexColors===!0&&!!W.attributes.color&&W.attributes.color.itemSize===4,Xe=!!W.attributes.tangent&&(!!X.normalMap||X.anisotropy>0),Ue=!!W.morphAttributes.position,st=!!W.morphAttributes.normal,St=!!W.morphAttributes.color;let yt=us;X.toneMapped&&(U===null||U.isXRRenderTarget===!0)&&(yt=M.toneMapping);const sn=W.morphAttributes.position||W.morphAttributes.normal||W.morphAttributes.color,lt=sn!==void 0?sn.length:0,Be=Pe.get(X),Ot=d.state.lights;if(ae===!0&&(ge===!0||E!==y)){const xn=E===y&&X.id===T;fe.setState(X,E,xn)}let ut=!1;X.version===Be.__version?(Be.needsLights&&Be.lightsStateVersion!==Ot.state.version||Be.outputColorSpace!==Fe||z.isBatchedMesh&&Be.batching===!1||!z.isBatchedMesh&&Be.batching===!0||z.isBatchedMesh&&Be.batchingColor===!0&&z.colorTexture===null||z.isBatchedMesh&&Be.batchingColor===!1&&z.colorTexture!==null||z.isInstancedMesh&&Be.instancing===!1||!z.isInstancedMesh&&Be.instancing===!0||z.isSkinnedMesh&&Be.skinning===!1||!z.isSkinnedMesh&&Be.skinning===!0||z.isInstancedMesh&&Be.instancingColor===!0&&z.instanceColor===null||z.isInstancedMesh&&Be.instancingColor===!1&&z.instanceColor!==null||z.isInstancedMesh&&Be.instancingMorph===!0&&z.morphTexture===null||z.isInstancedMesh&&Be.instancingMorph===!1&&z.morphTexture!==null||Be.envMap!==Le||X.fog===!0&&Be.fog!==he||Be.numClippingPlanes!==void 0&&(Be.numClippingPlanes!==fe.numPlanes||Be.numIntersection!==fe.numIntersection)||Be.vertexAlphas!==Ge||Be.vertexTangents!==Xe||Be.morphTargets!==Ue||Be.morphNormals!==st||Be.morphColors!==St||Be.toneMapping!==yt||Be.morphTargetsCount!==lt)&&(ut=!0):(ut=!0,Be.__version=X.version);let Pn=Be.currentProgram;ut===!0&&(Pn=Gs(X,N,z));let vi=!1,fn=!1,vs=!1;const At=Pn.getUniforms(),qn=Be.uniforms;if(He.useProgram(Pn.program)&&(vi=!0,fn=!0,vs=!0),X.id!==T&&(T=X.id,fn=!0),vi||y!==E){He.buffers.depth.getReversed()?(oe.copy(E.projectionMatrix),rv(oe),ov(oe),At.setValue(k,"projectionMatrix",oe)):At.setValue(k,"projectionMatrix",E.projectionMatrix),At.setValue(k,"viewMatrix",E.matrixWorldInverse);const xi=At.map.cameraPosition;xi!==void 0&&xi.setValue(k,Ve.setFromMatrixPosition(E.matrixWorld)),Qe.logarithmicDepthBuffer&&At.setValue(k,"logDepthBufFC",2/(Math.log(E.far+1)/Math.LN2)),(X.isMeshPhongMaterial||X.isMeshToonMaterial||X.isMeshLambertMaterial||X.isMeshBasicMaterial||X.isMeshStandardMaterial||X.isShaderMaterial)&&At.setValue(k,"isOrthographic",E.isOrthographicCamera===!0),y!==E&&(y=E,fn=!0,vs=!0)}if(z.isSkinnedMesh){At.setOptional(k,z,"bindMatrix"),At.setOptional(k,z,"bindMatrixInverse");const xn=z.skeleton;xn&&(xn.boneTexture===null&&xn.computeBoneTexture(),At.setValue(k,"boneTexture",xn.boneTexture,C))}z.isBatchedMesh&&(At.setOptional(k,z,"batchingTexture"),At.setValue(k,"batchingTexture",z._matricesTexture,C),At.setOptional(k,z,"batchingIdTexture"),At.setValue(k,"batchingIdTexture",z._indirectTexture,C),At.setOptional(k,z,"batchingColorTexture"),z._colorsTexture!==null&&At.setValue(k,"batchingColorTexture",z._colorsTexture,C));const ji=W.morphAttributes;if((ji.position!==void 0||ji.normal!==void 0||ji.color!==void 0)&&Oe.update(z,W,Pn),(fn||Be.receiveShadow!==z.receiveShadow)&&(Be.receiveShadow=z.receiveShadow,At.setValue(k,"receiveShadow",z.receiveShadow)),X.isMeshGouraudMaterial&&X.envMap!==null&&(qn.envMap.value=Le,qn.flipEnvMap.value=Le.isCubeTexture&&Le.isRenderTargetTexture===!1?-1:1),X.isMeshStandardMaterial&&X.envMap===null&&N.environment!==null&&(qn.envMapIntensity.value=N.environmentIntensity),fn&&(At.setValue(k,"toneMappingExposure",M.toneMappingExposure),Be.needsLights&&_s(qn,vs),he&&X.fog===!0&&_e.refreshFogUniforms(qn,he),_e.refreshMaterialUniforms(qn,X,Q,ee,d.state.transmissionRenderTarget[E.id]),_a.upload(k,Co(Be),qn,C)),X.isShaderMaterial&&X.uniformsNeedUpdate===!0&&(_a.upload(k,Co(Be),qn,C),X.uniformsNeedUpdate=!1),X.isSpriteMaterial&&At.setValue(k,"center",z.center),At.setValue(k,"modelViewMatrix",z.modelViewMatrix),At.setValue(k,"normalMatrix",z.normalMatrix),At.setValue(k,"modelMatrix",z.matrixWorld),X.isShaderMaterial||X.isRawShaderMaterial){const xn=X.uniformsGroups;for(let xi=0,ti=xn.length;xi<ti;xi++){const Ws=xn[xi];O.update(Ws,Pn),O.bind(Ws,Pn)}}return Pn}function _s(E,N){E.ambientLightColor.needsUpdate=N,E.lightProbe.needsUpdate=N,E.directionalLights.needsUpdate=N,E.directionalLightShadows.needsUpdate=N,E.pointLights.needsUpdate=N,E.pointLightShadows.needsUpdate=N,E.spotLights.needsUpdate=N,E.spotLightShadows.needsUpdate=N,E.rectAreaLights.needsUpdate=N,E.hemisphereLights.needsUpdate=N}function Ro(E){return E.isMeshLambertMaterial||E.isMeshToonMaterial||E.isMeshPhongMaterial||E.isMeshStandardMaterial||E.isShadowMaterial||E.isShaderMaterial&&E.lights===!0}this.getActiveCubeFace=function(){return D},this.getActiveMipmapLevel=function(){return L},this.getRenderTarget=function(){return U},this.setRenderTargetTextures=function(E,N,W){Pe.get(E.texture).__webglTexture=N,Pe.get(E.depthTexture).__webglTexture=W;const X=Pe.get(E);X.__hasExternalTextures=!0,X.__autoAllocateDepthBuffer=W===void 0,X.__autoAllocateDepthBuffer||$e.has("WEBGL_multisampled_render_to_texture")===!0&&(console.warn("THREE.WebGLRenderer: Render-to-texture extension was disabled because an external texture was provided"),X.__useRenderToTexture=!1)},this.setRenderTargetFramebuffer=function(E,N){const W=Pe.get(E);W.__webglFramebuffer=N,W.__useDefaultFramebuffer=N===void 0},this.setRenderTarget=function(E,N=0,W=0){U=E,D=N,L=W;let X=!0,z=null,he=!1,ye=!1;if(E){const Le=Pe.get(E);if(Le.__useDefaultFramebuffer!==void 0)He.bindFramebuffer(k.FRAMEBUFFER,null),X=!1;else if(Le.__webglFramebuffer===void 0)C.setupRenderTarget(E);else if(Le.__hasExternalTextures)C.rebindTextures(E,Pe.get(E.texture).__webglTexture,Pe.get(E.depthTexture).__webglTexture);else if(E.depthBuffer){const Ue=E.depthTexture;if(Le.__boundDepthTexture!==Ue){if(Ue!==null&&Pe.has(Ue)&&(E.width!==Ue.image.width||E.height!==Ue.image.height))throw new Error("WebGLRenderTarget: Attached DepthTexture is initialized to the incorrect size.");C.setupDepthRenderbuffer(E)}}const Ge=E.texture;(Ge.isData3DTexture||Ge.isDataArrayTexture||Ge.isCompressedArrayTexture)&&(ye=!0);const Xe=Pe.get(E).__webglFramebuffer;E.isWebGLCubeRenderTarget?(Array.isArray(Xe[N])?z=Xe[N][W]:z=Xe[N],he=!0):E.samples>0&&C.useMultisampledRTT(E)===!1?z=Pe.get(E).__webglMultisampledFramebuffer:Array.isArray(Xe)?z=Xe[W]:z=Xe,R.copy(E.viewport),K.copy(E.scissor),F=E.scissorTest}else R.copy(me).multiplyScalar(Q).floor(),K.copy(Se).multiplyScalar(Q).floor(),F=pe;if(He.bindFramebuffer(k.FRAMEBUFFER,z)&&X&&He.drawBuffers(E,z),He.viewport(R),He.scissor(K),He.setScissorTest(F),he){const Le=Pe.get(E.texture);k.framebufferTexture2D(k.FRAMEBUFFER,k.COLOR_ATTACHMENT0,k.TEXTURE_CUBE_MAP_POSITIVE_X+N,Le.__webglTexture,W)}else if(ye){const Le=Pe.get(E.texture),Ge=N||0;k.framebufferTextureLayer(k.FRAMEBUFFER,k.COLOR_ATTACHMENT0,Le.__webglTexture,W||0,Ge)}T=-1},this.readRenderTargetPixels=function(E,N,W,X,z,he,ye){if(!(E&&E.isWebGLRenderTarget)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Fe=Pe.get(E).__webglFramebuffer;if(E.isWebGLCubeRenderTarget&&ye!==void 0&&(Fe=Fe[ye]),Fe){He.bindFramebuffer(k.FRAMEBUFFER,Fe);try{const Le=E.texture,Ge=Le.format,Xe=Le.type;if(!Qe.textureFormatReadable(Ge)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(!Qe.textureTypeReadable(Xe)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}N>=0&&N<=E.width-X&&W>=0&&W<=E.height-z&&k.readPixels(N,W,X,z,Ye.convert(Ge),Ye.convert(Xe),he)}finally{const Le=U!==null?Pe.get(U).__webglFramebuffer:null;He.bindFramebuffer(k.FRAMEBUFFER,Le)}}},this.readRenderTargetPixelsAsync=async function(E,N,W,X,z,he,ye){if(!(E&&E.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Fe=Pe.get(E).__webglFramebuffer;if(E.isWebGLCubeRenderTarget&&ye!==void 0&&(Fe=Fe[ye]),Fe){const Le=E.texture,Ge=Le.format,Xe=Le.type;if(!Qe.textureFormatReadable(Ge))throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(!Qe.textureTypeReadable(Xe))throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");if(N>=0&&N<=E.width-X&&W>=0&&W<=E.height-z){He.bindFramebuffer(k.FRAMEBUFFER,Fe);const Ue=k.createBuffer();k.bindBuffer(k.PIXEL_PACK_BUFFER,Ue),k.bufferData(k.PIXEL_PACK_BUFFER,he.byteLength,k.STREAM_READ),k.readPixels(N,W,X,z,Ye.convert(Ge),Ye.convert(Xe),0);const st=U!==null?Pe.get(U).__webglFramebuffer:null;He.bindFramebuffer(k.FRAMEBUFFER,st);const St=k.fenceSync(k.SYNC_GPU_COMMANDS_COMPLETE,0);return k.flush(),await sv(k,St,4),k.bindBuffer(k.PIXEL_PACK_BUFFER,Ue),k.getBufferSubData(k.PIXEL_PACK_BUFFER,0,he),k.deleteBuffer(Ue),k.deleteSync(St),he}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")}},this.copyFramebufferToTexture=function(E,N=null,W=0){E.isTexture!==!0&&(lo("WebGLRenderer: copyFramebufferToTexture function signature has changed."),N=arguments[0]||null,E=arguments[1]);const X=Math.pow(2,-W),z=Math.floor(E.image.width*X),he=Math.floor(E.image.height*X),ye=N!==null?N.x:0,Fe=N!==null?N.y:0;C.setTexture2D(E,0),k.copyTexSubImage2D(k.TEXTURE_2D,W,0,0,ye,Fe,z,he),He.unbindTexture()},this.copyTextureToTexture=function(E,N,W=null,X=null,z=0){E.isTexture!==!0&&(lo("WebGLRenderer: copyTextureToTexture function signature has changed."),X=arguments[0]||null,E=arguments[1],N=arguments[2],z=arguments[3]||0,W=null);let he,ye,Fe,Le,Ge,Xe,Ue,st,St;const yt=E.isCompressedTexture?E.mipmaps[z]:E.image;W!==null?(he=W.max.x-W.min.x,ye=W.max.y-W.min.y,Fe=W.isBox3?W.max.z-W.min.z:1,Le=W.min.x,Ge=W.min.y,Xe=W.isBox3?W.min.z:0):(he=yt.width,ye=yt.height,Fe=yt.depth||1,Le=0,Ge=0,Xe=0),X!==null?(Ue=X.x,st=X.y,St=X.z):(Ue=0,st=0,St=0);const sn=Ye.convert(N.format),lt=Ye.convert(N.type);let Be;N.isData3DTexture?(C.setTexture3D(N,0),Be=k.TEXTURE_3D):N.isDataArrayTexture||N.isCompressedArrayTexture?(C.setTexture2DArray(N,0),Be=k.TEXTURE_2D_ARRAY):(C.setTexture2D(N,0),Be=k.TEXTURE_2D),k.pixelStorei(k.UNPACK_FLIP_Y_WEBGL,N.flipY),k.pixelStorei(k.UNPACK_PREMULTIPLY_ALPHA_WEBGL,N.premultiplyAlpha),k.pixelStorei(k.UNPACK_ALIGNMENT,N.unpackAlignment);const Ot=k.getParameter(k.UNPACK_ROW_LENGTH),ut=k.getParameter(k.UNPACK_IMAGE_HEIGHT),Pn=k.getParameter(k.UNPACK_SKIP_PIXELS),vi=k.getParameter(k.UNPACK_SKIP_ROWS),fn=k.getParameter(k.UNPACK_SKIP_IMAGES);k.pixelStorei(k.UNPACK_ROW_LENGTH,yt.width),k.pixelStorei(k.UNPACK_IMAGE_HEIGHT,yt.height),k.pixelStorei(k.UNPACK_SKIP_PIXELS,Le),k.pixelStorei(k.UNPACK_SKIP_ROWS,Ge),k.pixelStorei(k.UNPACK_SKIP_IMAGES,Xe);const vs=E.isDataArrayTexture||E.isData3DTexture,At=N.isDataArrayTexture||N.isData3DTexture;if(E.isRenderTargetTexture||E.isDepthTexture){const qn=Pe.get(E),ji=Pe.get(N),xn=Pe.get(qn.__renderTarget),xi=Pe.get(ji.__renderTarget);He.bindFramebuffer(k.READ_FRAMEBUFFER,xn.__webglFramebuffer),He.bindFramebuffer(k.DRAW_FRAMEBUFFER,xi.__webglFramebuffer);for(let ti=0;ti<Fe;ti++)vs&&k.framebufferTextureLayer(k.READ_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Pe.get(E).__webglTexture,z,Xe+ti),E.isDepthTexture?(At&&k.framebufferTextureLayer(k.DRAW_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Pe.get(N).__webglTexture,z,St+ti),k.blitFramebuffer(Le,Ge,he,ye,Ue,st,he,ye,k.DEPTH_BUFFER_BIT,k.NEAREST)):At?k.copyTexSubImage3D(Be,z,Ue,st,St+ti,Le,Ge,he,ye):k.copyTexSubImage2D(Be,z,Ue,st,St+ti,Le,Ge,he,ye);He.bindFramebuffer(k.READ_FRAMEBUFFER,null),He.bindFramebuffer(k.DRAW_FRAMEBUFFER,null)}else At?E.isDataTexture||E.isData3DTexture?k.texSubImage3D(Be,z,Ue,st,St,he,ye,Fe,sn,lt,yt.data):N.isCompressedArrayTexture?k.compressedTexSubImage3D(Be,z,Ue,st,St,he,ye,Fe,sn,yt.data):k.texSubImage3D(Be,z,Ue,st,St,he,ye,Fe,sn,lt,yt):E.isDataTexture?k.texSubImage2D(k.TEXTURE_2D,z,Ue,st,he,ye,sn,lt,yt.data):E.isCompressedTexture?k.compressedTexSubImage2D(k.TEXTURE_2D,z,Ue,st,yt.width,yt.height,sn,yt.data):k.texSubImage2D(k.TEXTURE_2D,z,Ue,st,he,ye,sn,lt,yt);k.pixelStorei(k.UNPACK_ROW_LENGTH,Ot),k.pixelStorei(k.UNPACK_IMAGE_HEIGHT,ut),k.pixelStorei(k.UNPACK_SKIP_PIXELS,Pn),k.pixelStorei(k.UNPACK_SKIP_ROWS,vi),k.pixelStorei(k.UNPACK_SKIP_IMAGES,fn),z===0&&N.generateMipmaps&&k.generateMipmap(Be),He.unbindTexture()},this.copyTextureToTexture3D=function(E,N,W=null,X=null,z=0){return E.isTexture!==!0&&(lo("WebGLRenderer: copyTextureToTexture3D function signature has changed."),W=arguments[0]||null,X=arguments[1]||null,E=arguments[2],N=arguments[3],z=arguments[4]||0),lo('WebGLRenderer: copyTextureToTexture3D function has been deprecated. Use "copyTextureToTexture" instead.'),this.copyTextureToTexture(E,N,W,X,z)},this.initRenderTarget=function(E){Pe.get(E).__webglFramebuffer===void 0&&C.setupRenderTarget(E)},this.initTexture=function(E){E.isCubeTexture?C.setTextureCube(E,0):E.isData3DTexture?C.setTexture3D(E,0):E.isDataArrayTexture||E.isCompressedArrayTexture?C.setTexture2DArray(E,0):C.setTexture2D(E,0),He.unbindTexture()},this.resetState=function(){D=0,L=0,U=null,He.reset(),ht.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Vi}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;const t=this.getContext();t.drawingBufferColorspace=ft._getDrawingBufferColorSpace(e),t.unpackColorSpace=ft._getUnpackColorSpace()}}let _E=class extends An{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new qi,this.environmentIntensity=1,this.environmentRotation=new qi,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),e.background!==null&&(this.background=e.background.clone()),e.environment!==null&&(this.environment=e.environment.clone()),e.fog!==null&&(this.fog=e.fog.clone()),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),e.overrideMaterial!==null&&(this.overrideMaterial=e.overrideMaterial.clone()),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){const t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),this.backgroundBlurriness>0&&(t.object.backgroundBlurriness=this.backgroundBlurriness),this.backgroundIntensity!==1&&(t.object.backgroundIntensity=this.backgroundIntensity),t.object.backgroundRotation=this.backgroundRotation.toArray(),this.environmentIntensity!==1&&(t.object.environmentIntensity=this.environmentIntensity),t.object.environmentRotation=this.environmentRotation.toArray(),t}};class vE{constructor(e,t){this.isInterleavedBuffer=!0,this.array=e,this.stride=t,this.count=e!==void 0?e.length/t:0,this.usage=qc,this.updateRanges=[],this.version=0,this.uuid=Wi()}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.array=new e.array.constructor(e.array),this.count=e.count,this.stride=e.stride,this.usage=e.usage,this}copyAt(e,t,n){e*=this.stride,n*=t.stride;for(let s=0,r=this.stride;s<r;s++)this.array[e+s]=t.array[n+s];return this}set(e,t=0){return this.array.set(e,t),this}clone(e){e.arrayBuffers===void 0&&(e.arrayBuffers={}),this.array.buffer._uuid===void 0&&(this.array.buffer._uuid=Wi()),e.arrayBuffers[this.array.buffer._uuid]===void 0&&(e.arrayBuffers[this.array.buffer._uuid]=this.array.slice(0).buffer);const t=new this.array.constructor(e.arrayBuffers[this.array.buffer._uuid]),n=new this.constructor(t,this.stride);return n.setUsage(this.usage),n}onUpload(e){return this.onUploadCallback=e,this}toJSON(e){return e.arrayBuffers===void 0&&(e.arrayBuffers={}),this.array.buffer._uuid===void 0&&(this.array.buffer._uuid=Wi()),e.arrayBuffers[this.array.buffer._uuid]===void 0&&(e.arrayBuffers[this.array.buffer._uuid]=Array.from(new Uint32Array(this.array.buffer))),{uuid:this.uuid,buffer:this.array.buffer._uuid,type:this.array.constructor.name,stride:this.stride}}}const En=new H;class Ta{constructor(e,t,n,s=!1){this.isInterleavedBufferAttribute=!0,this.name="",this.data=e,this.itemSize=t,this.offset=n,this.normalized=s}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(e){this.data.needsUpdate=e}applyMatrix4(e){for(let t=0,n=this.data.count;t<n;t++)En.fromBufferAttribute(this,t),En.applyMatrix4(e),this.setXYZ(t,En.x,En.y,En.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)En.fromBufferAttribute(this,t),En.applyNormalMatrix(e),this.setXYZ(t,En.x,En.y,En.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)En.fromBufferAttribute(this,t),En.transformDirection(e),this.setXYZ(t,En.x,En.y,En.z);return this}getComponent(e,t){let n=this.array[e*this.data.stride+this.offset+t];return this.normalized&&(n=ui(n,this.array)),n}setComponent(e,t,n){return this.normalized&&(n=Et(n,this.array)),this.data.array[e*this.data.stride+this.offset+t]=n,this}setX(e,t){return this.normalized&&(t=Et(t,this.array)),this.data.array[e*this.data.stride+this.offset]=t,this}setY(e,t){return this.normalized&&(t=Et(t,this.array)),this.data.array[e*this.data.stride+this.offset+1]=t,this}setZ(e,t){return this.normalized&&(t=Et(t,this.array)),this.data.array[e*this.data.stride+this.offset+2]=t,this}setW(e,t){return this.normalized&&(t=Et(t,this.array)),this.data.array[e*this.data.stride+this.offset+3]=t,this}getX(e){let t=this.data.array[e*this.data.stride+this.offset];return this.normalized&&(t=ui(t,this.array)),t}getY(e){let t=this.data.array[e*this.data.stride+this.offset+1];return this.normalized&&(t=ui(t,this.array)),t}getZ(e){let t=this.data.array[e*this.data.stride+this.offset+2];return this.normalized&&(t=ui(t,this.array)),t}getW(e){let t=this.data.array[e*this.data.stride+this.offset+3];return this.normalized&&(t=ui(t,this.array)),t}setXY(e,t,n){return e=e*this.data.stride+this.offset,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array)),this.data.array[e+0]=t,this.data.array[e+1]=n,this}setXYZ(e,t,n,s){return e=e*this.data.stride+this.offset,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array),s=Et(s,this.array)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e=e*this.data.stride+this.offset,this.normalized&&(t=Et(t,this.array),n=Et(n,this.array),s=Et(s,this.array),r=Et(r,this.array)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=s,this.data.array[e+3]=r,this}clone(e){if(e===void 0){console.log("THREE.InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.");const t=[];for(let n=0;n<this.count;n++){const s=n*this.data.stride+this.offset;for(let r=0;r<this.itemSize;r++)t.push(this.data.array[s+r])}return new Cn(new this.array.constructor(t),this.itemSize,this.normalized)}else return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.clone(e)),new Ta(e.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(e){if(e===void 0){console.log("THREE.InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.");const t=[];for(let n=0;n<this.count;n++){const s=n*this.data.stride+this.offset;for(let r=0;r<this.itemSize;r++)t.push(this.data.array[s+r])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:t,normalized:this.normalized}}else return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.toJSON(e)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}}class zp extends wn{constructor(e=null,t=1,n=1,s,r,o,a,l,c=Xn,u=Xn,h,f){super(null,o,a,l,c,u,s,r,h,f),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}}class Fr extends Vr{static get type(){return"LineBasicMaterial"}constructor(e){super(),this.isLineBasicMaterial=!0,this.color=new xt(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}}const wa=new H,Aa=new H,Xf=new Nt,io=new Ha,ra=new To,Wl=new H,Yf=new H;class So extends An{constructor(e=new vn,t=new Fr){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){const e=this.geometry;if(e.index===null){const t=e.attributes.position,n=[0];for(let s=1,r=t.count;s<r;s++)wa.fromBufferAttribute(t,s-1),Aa.fromBufferAttribute(t,s),n[s]=n[s-1],n[s]+=wa.distanceTo(Aa);e.setAttribute("lineDistance",new fs(n,1))}else console.warn("THREE.Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}raycast(e,t){const n=this.geometry,s=this.matrixWorld,r=e.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),ra.copy(n.boundingSphere),ra.applyMatrix4(s),ra.radius+=r,e.ray.intersectsSphere(ra)===!1)return;Xf.copy(s).invert(),io.copy(e.ray).applyMatrix4(Xf);const a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,u=n.index,f=n.attributes.position;if(u!==null){const m=Math.max(0,o.start),_=Math.min(u.count,o.start+o.count);for(let v=m,p=_-1;v<p;v+=c){const d=u.getX(v),b=u.getX(v+1),w=oa(this,e,io,l,d,b);w&&t.push(w)}if(this.isLineLoop){const v=u.getX(_-1),p=u.getX(m),d=oa(this,e,io,l,v,p);d&&t.push(d)}}else{const m=Math.max(0,o.start),_=Math.min(f.count,o.start+o.count);for(let v=m,p=_-1;v<p;v+=c){const d=oa(this,e,io,l,v,v+1);d&&t.push(d)}if(this.isLineLoop){const v=oa(this,e,io,l,_-1,m);v&&t.push(v)}}}updateMorphTargets(){const t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){const s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){const a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}}function oa(i,e,t,n,s,r){const o=i.geometry.attributes.position;if(wa.fromBufferAttribute(o,s),Aa.fromBufferAttribute(o,r),t.distanceSqToSegment(wa,Aa,Wl,Yf)>n)return;Wl.applyMatrix4(i.matrixWorld);const l=e.ray.origin.distanceTo(Wl);if(!(l<e.near||l>e.far))return{distance:l,point:Yf.clone().applyMatrix4(i.matrixWorld),index:s,face:null,faceIndex:null,barycoord:null,object:i}}class bh extends Vr{static get type(){return"PointsMaterial"}constructor(e){super(),this.isPointsMaterial=!0,this.color=new xt(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}}const qf=new Nt,$c=new Ha,aa=new To,la=new H;class Th extends An{constructor(e=new vn,t=new bh){super(),this.isPoints=!0,this.type="Points",this.geometry=e,this.material=t,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}raycast(e,t){const n=this.geometry,s=this.matrixWorld,r=e.params.Points.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),aa.copy(n.boundingSphere),aa.applyMatrix4(s),aa.radius+=r,e.ray.intersectsSphere(aa)===!1)return;qf.copy(s).invert(),$c.copy(e.ray).applyMatrix4(qf);const a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=n.index,h=n.attributes.position;if(c!==null){const f=Math.max(0,o.start),m=Math.min(c.count,o.start+o.count);for(let _=f,v=m;_<v;_++){const p=c.getX(_);la.fromBufferAttribute(h,p),jf(la,p,l,s,e,t,this)}}else{const f=Math.max(0,o.start),m=Math.min(h.count,o.start+o.count);for(let _=f,v=m;_<v;_++)la.fromBufferAttribute(h,_),jf(la,_,l,s,e,t,this)}}updateMorphTargets(){const t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){const s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){const a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}}function jf(i,e,t,n,s,r,o){const a=$c.distanceSqToPoint(i);if(a<t){const l=new H;$c.closestPointToPoint(i,l),l.applyMatrix4(n);const c=s.ray.origin.distanceTo(l);if(c<s.near||c>s.far)return;r.push({distance:c,distanceToRay:Math.sqrt(a),point:l,index:e,face:null,faceIndex:null,barycoord:null,object:o})}}class Jc{constructor(e=1,t=0,n=0){return this.radius=e,this.phi=t,this.theta=n,this}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=Math.max(1e-6,Math.min(Math.PI-1e-6,this.phi)),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(gn(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}}class xE extends Hs{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(){}disconnect(){}dispose(){}update(){}}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:mh}}));typeof window<"u"&&(window.__THREE__?console.warn("WARNING: Multiple instances of Three.js being imported."):window.__THREE__=mh);const SE=16384,ME=.5,yE=new H(1,1,1);class Qc{constructor(){this.frames=new Map,this.begun=0}end(){++this.begun}add({time:e,child:t,position:n,rotation:s}){this.frames.has(t)||this.frames.set(t,[]);const r=this.frames.get(t),o=r.at(-1)?.begun!==this.begun;for(;o&&r.length>0&&r.at(-1).time>=e;)r.pop();r.length>0&&e<=r.at(-1).time||(r.push({time:e,begun:this.begun,position:new H(...n),rotation:new ms(...s).normalize()}),r.length>SE&&r.shift())}at(e,t){const n=this.frames.get(e)??[];if(n.length===0)return null;const s=n.findLastIndex(h=>h.time<=t)+1;let r=Math.min(Math.max(s,1),n.length-1);r>0&&n[r-1].begun!==n[r].begun&&t-n[r-1].time<n[r].time-t&&--r;const a=n[r];if(t>a.time&&a.begun!==this.begun)return null;const l=n[r-1]?.begun===a.begun?n[r-1]:a,c=Math.min(t,a.time+ME),u=a.time>l.time?Math.max((c-l.time)/(a.time-l.time),0):1;return new Nt().compose(l.position.clone().lerp(a.position,u),l.rotation.clone().slerp(a.rotation,u),yE)}}const EE=1,Kf=({schemaName:i,schema:e})=>{try{return i==="lidar.Slice"&&JSON.parse(e).recording===!0}catch{return!1}};class bE{constructor(e,t){Object.assign(this,{on:e,connection:t}),this.number=0,this.isOn=!1,this.streams=new Map,this.recordings=new Map,this.wanted=null}get channels(){return[...this.connection()?.subscriptions.values()??[]].filter(Kf)}get span(){const e=[...this.recordings.values()].filter(({to:t})=>t>0);return e.length?[Math.min(...e.map(t=>t.from)),Math.max(...e.map(t=>t.to))]:null}get isBroken(){return this.recordings.size>0&&this.span===null}get isDamaged(){return[...this.recordings.values()].some(({damaged:e})=>e>0)}begin(e){this.number=this.number%65535+1,this.isOn=!0,this.time=this.wanted=e,this.drop(),this.on.begin(this.number);for(const t of this.channels)this.streams.set(t,{newest:null,end:null,unshown:[]}),this.connection().tell("replay",t,{number:this.number,time:e})}end(){if(!this.isOn)return;const e=[...this.streams.keys()];this.drop();for(const t of e)this.connection().tell("live",t);this.isOn=!1,this.wanted=null,this.on.end()}drop(){for(const[e,{unshown:t}]of this.streams)t.length>0&&this.tell(e,t.at(-1));this.streams.clear()}tell(e,{scan:t,slice:n}){this.connection().tell("drawn",e,{scan:t,slice:n})}subscribed(e){const t=[...this.connection().offered.values()];for(const n of this.recordings.keys())t.includes(n)||this.recordings.delete(n);this.isOn&&Kf(e)&&this.begin(this.time)}dropped(e){this.streams.delete(e)}forget(){this.recordings.clear(),this.on.known()}status(e,{number:t,from:n,to:s,damaged:r,end:o}){this.recordings.set(e,{from:n,to:s,damaged:r});const a=t===this.number?this.streams.get(e):void 0;a&&(a.end=o),this.on.known(),this.release()}arrived(e,t){const n=this.streams.get(e);if(!n||t.replay!==this.number)return this.tell(e,t);t.isPose||(n.newest=Math.max(n.newest??0,t.captured)),n.unshown.push(t),this.release()}isWhole({newest:e,end:t}){return t!==null&&(e??0)>=t}get reach(){return this.streams.size===0?-1/0:Math.min(...[...this.streams.values()].map(e=>this.isWhole(e)?1/0:e.newest??-1/0))}get last(){const e=[...this.streams.values()];return e.length===0||!e.every(t=>this.isWhole(t))?1/0:Math.max(...e.map(({newest:t})=>t??-1/0))}show(e){this.time=this.wanted=e,this.release()}release(){if(this.wanted===null||this.wanted>this.reach)return;const e=this.wanted;this.wanted=null,this.on.show(e)}acknowledge(){for(const[e,{unshown:t}]of this.streams){let n=null;for(;t.length>0&&t[0].captured<=this.time+EE;)n=t.shift();n&&this.tell(e,n)}}}const Zf={type:"change"},wh={type:"start"},Vp={type:"end"},ca=new Ha,$f=new as,TE=Math.cos(70*Kc.DEG2RAD),Zt=new H,Dn=2*Math.PI,wt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Xl=1e-6;class wE extends xE{constructor(e,t=null){super(e,t),this.state=wt.NONE,this.enabled=!0,this.target=new H,this.cursor=new H,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:Mr.ROTATE,MIDDLE:Mr.DOLLY,RIGHT:Mr.PAN},this.touches={ONE:vr.ROTATE,TWO:vr.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._domElementKeyEvents=null,this._lastPosition=new H,this._lastQuaternion=new ms,this._lastTargetPosition=new H,this._quat=new ms().setFromUnitVectors(e.up,new H(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Jc,this._sphericalDelta=new Jc,this._scale=1,this._panOffset=new H,this._rotateStart=new nt,this._rotateEnd=new nt,this._rotateDelta=new nt,this._panStart=new nt,this._panEnd=new nt,this._panDelta=new nt,this._dollyStart=new nt,this._dollyEnd=new nt,this._dollyDelta=new nt,this._dollyDirection=new H,this._mouse=new nt,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=CE.bind(this),this._onPointerDown=AE.bind(this),this._onPointerUp=RE.bind(this),this._onContextMenu=FE.bind(this),this._onMouseWheel=LE.bind(this),this._onKeyDown=UE.bind(this),this._onTouchStart=IE.bind(this),this._onTouchMove=NE.bind(this),this._onMouseDown=PE.bind(this),this._onMouseMove=DE.bind(this),this._interceptControlDown=OE.bind(this),this._interceptControlUp=BE.bind(this),this.domElement!==null&&this.connect(),this.update()}connect(){this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.getRootNode().addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.domElement.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.getRootNode().removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.style.touchAction="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Zf),this.update(),this.state=wt.NONE}update(e=null){const t=this.object.position;Zt.copy(t).sub(this.target),Zt.applyQuaternion(this._quat),this._spherical.setFromVector3(Zt),this.autoRotate&&this.state===wt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=Dn:n>Math.PI&&(n-=Dn),s<-Math.PI?s+=Dn:s>Math.PI&&(s-=Dn),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{const o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(Zt.setFromSpherical(this._spherical),Zt.applyQuaternion(this._quatInverse),t.copy(this.target).add(Zt),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){const a=Zt.length();o=this._clampDistance(a*this._scale);const l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){const a=new H(this._mouse.x,this._mouse.y,0);a.unproject(this.object);const l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;const c=new H(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Zt.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(ca.origin.copy(this.object.position),ca.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(ca.direction))<TE?this.object.lookAt(this.target):($f.setFromNormalAndCoplanarPoint(this.object.up,this.target),ca.intersectPlane($f,this.target))))}else if(this.object.isOrthographicCamera){const o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Xl||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Xl||this._lastTargetPosition.distanceToSquared(this.target)>Xl?(this.dispatchEvent(Zf),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?Dn/60*this.autoRotateSpeed*e:Dn/60/60*this.autoRotateSpeed}_getZoomScale(e){const t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Zt.setFromMatrixColumn(t,0),Zt.multiplyScalar(-e),this._panOffset.add(Zt)}_panUp(e,t){this.screenSpacePanning===!0?Zt.setFromMatrixColumn(t,1):(Zt.setFromMatrixColumn(t,0),Zt.crossVectors(this.object.up,Zt)),Zt.multiplyScalar(e),this._panOffset.add(Zt)}_pan(e,t){const n=this.domElement;if(this.object.isPerspectiveCamera){const s=this.object.position;Zt.copy(s).sub(this.target);let r=Zt.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/n.clientHeight,this.object.matrix),this._panUp(2*t*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;const n=this.domElement.getBoundingClientRect(),s=e-n.left,r=t-n.top,o=n.width,a=n.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientX),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);const t=this.domElement;this._rotateLeft(Dn*this._rotateDelta.x/t.clientHeight),this._rotateUp(Dn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this._rotateUp(Dn*this.rotateSpeed/this.domElement.clientHeight):this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this._rotateUp(-Dn*this.rotateSpeed/this.domElement.clientHeight):this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this._rotateLeft(Dn*this.rotateSpeed/this.domElement.clientHeight):this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this._rotateLeft(-Dn*this.rotateSpeed/this.domElement.clientHeight):this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{const t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{const t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(n,s)}}_handleTouchStartDolly(e){const t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{const n=this._getSecondPointerPosition(e),s=.5*(e.pageX+n.x),r=.5*(e.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);const t=this.domElement;this._rotateLeft(Dn*this._rotateDelta.x/t.clientHeight),this._rotateUp(Dn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{const t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){const t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);const o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new nt,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){const t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){const t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}}function AE(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.addEventListener("pointermove",this._onPointerMove),this.domElement.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i)))}function CE(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function RE(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.domElement.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(Vp),this.state=wt.NONE;break;case 1:const e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function PE(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case Mr.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=wt.DOLLY;break;case Mr.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=wt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=wt.ROTATE}break;case Mr.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=wt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=wt.PAN}break;default:this.state=wt.NONE}this.state!==wt.NONE&&this.dispatchEvent(wh)}function DE(i){switch(this.state){case wt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case wt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case wt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function LE(i){this.enabled===!1||this.enableZoom===!1||this.state!==wt.NONE||(i.preventDefault(),this.dispatchEvent(wh),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(Vp))}function UE(i){this.enabled===!1||this.enablePan===!1||this._handleKeyDown(i)}function IE(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case vr.ROTATE:if(this.enableRotate===!1)return;this._handleTouchStartRotate(i),this.state=wt.TOUCH_ROTATE;break;case vr.PAN:if(this.enablePan===!1)return;this._handleTouchStartPan(i),this.state=wt.TOUCH_PAN;break;default:this.state=wt.NONE}break;case 2:switch(this.touches.TWO){case vr.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=wt.TOUCH_DOLLY_PAN;break;case vr.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=wt.TOUCH_DOLLY_ROTATE;break;default:this.state=wt.NONE}break;default:this.state=wt.NONE}this.state!==wt.NONE&&this.dispatchEvent(wh)}function NE(i){switch(this._trackPointer(i),this.state){case wt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case wt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case wt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case wt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=wt.NONE}}function FE(i){this.enabled!==!1&&i.preventDefault()}function OE(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.getRootNode().addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function BE(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.getRootNode().removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}const Jf=3,eh=64;function kE(i){const[e,t,n]=[0,1,7].map(a=>i[a]),s=Math.sqrt(e),r=s>0?t/s:0,o=Math.sqrt(Math.max(n-r*r,0));return Array.from({length:eh+1},(a,l)=>{const c=l/eh*2*Math.PI,[u,h]=[Jf*Math.cos(c),Jf*Math.sin(c)];return[s*u,r*u+o*h,0]}).flat()}class zE{constructor(){this.geometry=new vn,this.corners=new Cn(new Float32Array((eh+1)*3),3),this.geometry.setAttribute("position",this.corners),this.object=new So(this.geometry,new Fr),this.object.frustumCulled=!1,this.object.visible=!1}set(e){this.corners.array.set(kE(e)),this.corners.needsUpdate=!0}}const Qf=6e5,Yl=.4,VE=3,ed=2e4,HE=.2;class GE{constructor(){this.positions=new Float32Array(Qf*3);const e=new vn;this.attribute=new Cn(this.positions,3).setUsage(jc),e.setAttribute("position",this.attribute),this.material=new bh({size:1.4,sizeAttenuation:!1,transparent:!0}),this.points=new Th(e,this.material),this.points.frustumCulled=!1;const t=new vn;this.way=new Cn(new Float32Array(ed*3),3),t.setAttribute("position",this.way.setUsage(jc)),this.line=new So(t,new Fr({transparent:!0})),this.line.frustumCulled=!1,this.object=new cs,this.object.add(this.points,this.line),this.clear()}clear(){this.cubes=new Set,this.count=0,this.steps=0,this.points.geometry.setDrawRange(0,0),this.line.geometry.setDrawRange(0,0)}setColors(e,t){this.material.color.set(e),this.line.material.color.set(t)}add(e,t){const n=t.elements,s=this.count;for(let r=0;r<e.length&&this.count<Qf;r+=gi*VE){const o=e[r],a=e[r+1],l=e[r+2];this.addPoint(n[0]*o+n[4]*a+n[8]*l+n[12],n[1]*o+n[5]*a+n[9]*l+n[13],n[2]*o+n[6]*a+n[10]*l+n[14])}this.count>s&&(this.attribute.addUpdateRange(s*3,(this.count-s)*3),this.attribute.needsUpdate=!0,this.points.geometry.setDrawRange(0,this.count)),this.addStep(n[12],n[13],n[14])}addPoint(e,t,n){const s=Math.floor(e/Yl)&131071,r=Math.floor(t/Yl)&131071,o=Math.floor(n/Yl)&65535,a=(s*131072+r)*65536+o;if(this.cubes.has(a))return;this.cubes.add(a);const l=this.count++*3;this.positions[l]=e,this.positions[l+1]=t,this.positions[l+2]=n}addStep(e,t,n){const{array:s}=this.way,r=this.steps*3;this.steps>=ed||!(this.steps===0||Math.hypot(e-s[r-3],t-s[r-2],n-s[r-1])>HE)||(s.set([e,t,n],r),this.way.addUpdateRange(r,3),this.way.needsUpdate=!0,this.line.geometry.setDrawRange(0,++this.steps))}drawn(){this.attribute.clearUpdateRanges(),this.way.clearUpdateRanges()}}const WE={spectrum:["#3d4fa8","#3a73b4","#3697b0","#45b79b","#86d079","#cfe25f","#fff4a8"],glow:["#33415c","#56708f","#8ea3b5","#c9c6b8","#fff3d6"],fade:["#ffffff","#7fd6e0","#2f86d6","#2a3f78","#232c45"]},XE={spectrum:["#2a1a5e","#2f3f8f","#1f5f94","#14807f","#3f9a5c","#8fa52e","#c99f1e"],glow:["#b9c0c9","#8f9aa8","#657286","#3f4a60","#141a2b"],fade:["#0b1a33","#1f5c8f","#5b93bd","#a3bfd4","#ccd8e2"]},go={height:{label:"Height",unit:"m",ramp:"spectrum"},intensity:{label:"Intensity",unit:"",ramp:"glow"},range:{label:"Range",unit:"m",ramp:"spectrum"},beam:{label:"Beam",unit:"",ramp:"spectrum"},age:{label:"Age",unit:"ms",ramp:"fade"}},Ah=(i,e)=>(e?WE:XE)[go[i].ramp];function td(i){return[1,3,5].map(e=>parseInt(i.slice(e,e+2),16))}function Ch(i){const e=new Uint8Array(1024);for(let t=0;t<256;++t){const n=t/255*(i.length-1),s=Math.min(Math.floor(n),i.length-2),r=td(i[s]),o=td(i[s+1]);for(let a=0;a<3;++a)e[4*t+a]=Math.round(r[a]+(o[a]-r[a])*(n-s));e[4*t+3]=255}return e}const ai=1<<19,rs=gi+1,YE=1e6,Ca=1e6,qE=`
attribute vec4 rest;   // intensity, beam, range, time
uniform float now, span, hidden, mode, low, high, scale, floor, ceiling;
varying float vValue, vFresh, vSize;
void main() {
  float age = now - rest.w;
  float value = mode < 0.5 ? position.z : mode < 1.5 ? rest.x : mode < 2.5 ? rest.z
              : mode < 3.5 ? rest.y : age * 1000.0;
  vValue = clamp((value - low) / max(high - low, 1e-6), 0.0, 1.0);
  if (mode > 0.5 && mode < 1.5) vValue = sqrt(vValue);
  vFresh = clamp(1.0 - age / span, 0.0, 1.0);
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  bool isOut = age < -1e-4 || age > hidden || position.z < floor || position.z > ceiling;
  gl_Position = isOut ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * view;
  vSize = clamp(scale / -view.z, 1.6, 6.0);
  gl_PointSize = vSize;
}`,jE=`
uniform sampler2D ramp;
uniform float glow;
varying float vValue, vFresh, vSize;
void main() {
  vec2 corner = gl_PointCoord - 0.5;
  if (vSize > 2.5 && dot(corner, corner) > 0.25) discard; // near points are round
  vec3 color = texture2D(ramp, vec2(vValue, 0.5)).rgb;
  // What the sensor has just seen is brightest: the sweep shows.
  float bright = glow > 0.5 ? 0.62 + 0.38 * vFresh * vFresh : 1.0;
  gl_FragColor = vec4(color * bright, 1.0);
}`;class KE{constructor(){this.data=new Float32Array(ai*rs),this.isTrail=!1,this.buffer=new vE(this.data,rs).setUsage(jc);const e=new vn;e.setAttribute("position",new Ta(this.buffer,3,0)),e.setAttribute("rest",new Ta(this.buffer,4,3));const t=new zp(new Uint8Array(1024),256,1);t.magFilter=t.minFilter=pi,this.uniforms={now:{value:0},span:{value:.1},hidden:{value:.1},floor:{value:-Ca},ceiling:{value:Ca},mode:{value:0},low:{value:-2},high:{value:6},scale:{value:60},ramp:{value:t},glow:{value:1}};const n=new Ci({uniforms:this.uniforms,vertexShader:qE,fragmentShader:jE});this.parts=[e,e.clone()].map(s=>{for(const o of["position","rest"])s.setAttribute(o,e.getAttribute(o));const r=new Th(s,n);return r.frustumCulled=!1,r}),this.object=new cs,this.object.add(...this.parts),this.clear()}clear(){this.next=0,this.batches=[],this.scan=this.scanBefore=void 0,this.epoch=null,this.latest=0;for(const e of this.parts)e.geometry.setDrawRange(0,0)}get count(){return this.parts.reduce((e,t)=>e+t.geometry.drawRange.count,0)}get time(){return this.epoch===null?null:this.epoch+this.latest}add(e,t,n,s=null){const r=Math.min(e.length/gi,ai);(this.epoch===null||t-this.epoch>3600||t<this.epoch)&&(this.clear(),this.epoch=t);const o=t-this.epoch;this.latest=Math.max(this.latest,o);const a=n?.elements,{data:l}=this,c=this.next;for(let u=0,h=0;u<r;++u,h+=gi){const f=(c+u)%ai*rs,m=e[h],_=e[h+1],v=e[h+2];l[f]=a?a[0]*m+a[4]*_+a[8]*v+a[12]:m,l[f+1]=a?a[1]*m+a[5]*_+a[9]*v+a[13]:_,l[f+2]=a?a[2]*m+a[6]*_+a[10]*v+a[14]:v,l[f+3]=e[h+3],l[f+4]=e[h+4],l[f+5]=e[h+5],l[f+6]=o}this.markDirty(c,r),this.next=(c+r)%ai,this.batches.push({start:c,count:r,stamp:o,place:s}),s&&s.scan!==this.scan&&([this.scanBefore,this.scan]=[this.scan,s.scan]),this.applySpan(s!==null),this.forget()}isOver({stamp:e,place:t}){if(!t||this.isTrail)return e<this.latest-this.uniforms.hidden.value;if(t.scan===this.scan)return!1;const n=this.batches[this.batches.length-1].place;return t.scan!==this.scanBefore||!n?!0:(t.slice+1)*n.slices<=(n.slice+1)*t.slices}forget(){const{batches:e}=this;let t=e.reduce((r,o)=>r+o.count,0);for(;e.length>1&&(t>ai||this.isOver(e[0]));)t-=e.shift().count;const n=e.length?e[0].start:0,s=Math.min(t,ai-n);this.parts[0].geometry.setDrawRange(n,s),this.parts[1].geometry.setDrawRange(0,t-s)}markDirty(e,t){const n=Math.min(e+t,ai);this.buffer.addUpdateRange(e*rs,(n-e)*rs),e+t>ai&&this.buffer.addUpdateRange(0,(e+t-ai)*rs),this.buffer.needsUpdate=!0}spans(e,t){const n=Math.min(t,ai-e);return n<t?[[e,n],[0,t-n]]:[[e,t]]}each(e){const{floor:t,ceiling:n}=this.uniforms;for(const{start:s,count:r}of this.batches)for(let o=0;o<r;++o){const a=(s+o)%ai*rs,l=this.data[a+2];l>=t.value&&l<=n.value&&e(a)}}nearest(e,{width:t,height:n},[s,r],o){const a=new Nt().multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse).elements,{data:l}=this;let[c,u]=[o*o,null];return this.each(h=>{const[f,m,_]=[l[h],l[h+1],l[h+2]],v=a[3]*f+a[7]*m+a[11]*_+a[15];if(v<=0)return;const p=((a[0]*f+a[4]*m+a[8]*_+a[12])/v+1)*.5*t-s,d=(1-(a[1]*f+a[5]*m+a[9]*_+a[13])/v)*.5*n-r;p*p+d*d>=c||(c=p*p+d*d,u=[f,m,_])}),u}drawn(){this.buffer.clearUpdateRanges()}setColors(e,t){this.uniforms.mode.value=Object.keys(go).indexOf(e),this.uniforms.glow.value=t&&e!=="age"?1:0;const{value:n}=this.uniforms.ramp;n.image.data.set(Ch(Ah(e,t))),n.needsUpdate=!0}setScale(e,t){this.uniforms.low.value=e,this.uniforms.high.value=t}setSpan(e,t){this.uniforms.span.value=e,this.isTrail=t,this.applySpan(this.batches[this.batches.length-1]?.place)}applySpan(e){this.uniforms.hidden.value=e&&!this.isTrail?YE:this.uniforms.span.value}setClip(e,t){this.uniforms.floor.value=e,this.uniforms.ceiling.value=t}update(){this.uniforms.now.value=this.latest}}const ZE={height:2,intensity:3,range:5,beam:4},$E=6,JE=1.6,QE=/swiftshader|llvmpipe|softpipe|software|basic render/i;function eb(i){const e=i.getParameter(i.RENDERER)==="WebKit WebGL"&&i.getExtension("WEBGL_debug_renderer_info");return QE.test(i.getParameter(e?e.UNMASKED_RENDERER_WEBGL:i.RENDERER))}const Hp=(i,e,t)=>(4278190080|t<<16|e<<8|i)>>>0,nd=i=>{const e=i.getHex(Gn);return Hp(e>>16,e>>8&255,e&255)};class tb{constructor(){const e=new Ci({uniforms:{picture:{value:null}},vertexShader:"varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",fragmentShader:"uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at); }",depthTest:!1,depthWrite:!1});this.object=new Ai(new Ao(2,2),e),this.object.frustumCulled=!1,this.object.renderOrder=-1,this.table=new Uint32Array(256)}resize(e,t){this.width===e&&this.height===t||(Object.assign(this,{width:e,height:t}),this.pixels=new Uint32Array(e*t),this.depths=new Float32Array(e*t),this.texture?.dispose(),this.texture=new zp(new Uint8Array(this.pixels.buffer),e,t),this.object.material.uniforms.picture.value=this.texture)}setColors(e,t,n){this.mode=e,this.ramp=Ch(Ah(e,t)),this.ground=nd(n)}draw(e,t,n){this.pixels.fill(this.ground),this.depths.fill(1/0);const s=new Nt;s.multiplyMatrices(n.projectionMatrix,n.matrixWorldInverse),t.object.visible&&t.count>0&&(this.table.fill(nd(t.material.color)),this.splat(t.positions,{from:0,count:t.count,stride:3,value:2},s.elements,[0,0,0,0,1e9]));const{now:r,low:o,high:a,scale:l,floor:c,ceiling:u}=e.uniforms,h=this.mode==="intensity",f=255/Math.max(a.value-o.value,1e-6),m=[l.value,o.value,f,c.value,u.value];for(const{start:_,count:v,stamp:p}of e.batches){const d=r.value-p;if(d>e.uniforms.hidden.value)continue;this.tint(e.uniforms,d);const b=ZE[this.mode]??2;for(const[w,M]of e.spans(_,v))this.splat(e.data,{from:w,count:M,stride:rs,value:b,root:h},s.elements,m)}this.texture.needsUpdate=!0}tint({span:e,glow:t,low:n,high:s},r){const o=Math.min(Math.max(1-r/e.value,0),1),a=t.value>.5?.62+.38*o*o:1,l=(r*1e3-n.value)/Math.max(s.value-n.value,1e-6),c=this.mode==="age"?Math.round(255*Math.min(Math.max(l,0),1)):-1;for(let u=0;u<256;++u){const h=4*(c<0?u:c);this.table[u]=Hp(this.ramp[h]*a,this.ramp[h+1]*a,this.ramp[h+2]*a)}}splat(e,{from:t,count:n,stride:s,value:r,root:o=!1},a,[l,c,u,h,f]){const{width:m,height:_,pixels:v,depths:p,table:d}=this,[b,w]=[m/2,_/2];for(let M=0,B=t*s;M<n;++M,B+=s){const D=e[B],L=e[B+1],U=e[B+2];if(l>0&&(U<h||U>f))continue;const T=a[3]*D+a[7]*L+a[11]*U+a[15];if(T<=.1)continue;const y=Math.min(Math.max(l/T,JE),$E),R=((a[0]*D+a[4]*L+a[8]*U+a[12])/T+1)*b-y/2+.5|0,K=((a[1]*D+a[5]*L+a[9]*U+a[13])/T+1)*w-y/2+.5|0,F=y+.5|0;if(R<0||K<0||R+F>m||K+F>_)continue;let G=(e[B+r]-c)*u;o&&(G=15.97*Math.sqrt(Math.max(G,0)));const Z=d[G<0?0:G>255?255:G|0];for(let j=K*m+R,ee=j+F*m;j<ee;j+=m)for(let Q=j;Q<j+F;++Q)p[Q]<=T||(p[Q]=T,v[Q]=Z)}}}const nb=24,ib=6;class sb{constructor(e,t,n){Object.assign(this,{fresh:e,camera:t,canvas:n}),this.ends=new Cn(new Float32Array(6),3);const s=new vn().setAttribute("position",this.ends),r=new Fr({depthTest:!1}),o=new bh({size:9,sizeAttenuation:!1,depthTest:!1});this.object=new cs,this.object.add(new So(s,r),new Th(s,o));for(const a of this.object.children)a.frustumCulled=!1;this.object.renderOrder=1,this.isOn=!1,n.addEventListener("pointerdown",({clientX:a,clientY:l})=>this.down=[a,l]),n.addEventListener("pointerup",a=>this.choose(a)),this.set([])}setColor(e){for(const t of this.object.children)t.material.color.set(e)}turn(e){this.isOn=e,this.set([])}choose({clientX:e,clientY:t}){if(!this.isOn||!this.down||Math.hypot(e-this.down[0],t-this.down[1])>ib)return;const n=this.canvas.getBoundingClientRect(),s=this.fresh.nearest(this.camera,n,[e-n.left,t-n.top],nb);s&&this.set(this.points.length===1?[this.points[0],s]:[s])}set(e){this.points=e,this.object.visible=e.length>0,e.forEach((s,r)=>this.ends.setXYZ(r,...s)),e.length===1&&this.ends.setXYZ(1,...e[0]),this.ends.needsUpdate=!0;const[t,n]=e;this.onChange?.({points:e,distance:n?Math.hypot(n[0]-t[0],n[1]-t[1],n[2]-t[2]):null,rise:n?n[2]-t[2]:null})}}const rb=[10,20,30,40,50],ob=new H(-27,-9,24),id=new H(6,0,-1),sd=.08,ab=330,lb=.88;function cb(){const i=new cs;for(const n of rb){const s=Array.from({length:129},(o,a)=>{const l=a/128*2*Math.PI;return new H(n*Math.cos(l),n*Math.sin(l),0)}),r=new vn().setFromPoints(s);i.add(new So(r,new Fr({transparent:!0})))}const e=[[1.6,0],[-.9,.75],[-.5,0],[-.9,-.75],[1.6,0]].map(([n,s])=>new H(n,s,0)),t=new So(new vn().setFromPoints(e),new Fr);return t.name="sensor",i.add(t),i}class hb{constructor(e){this.canvas=e;const t=e.getContext("webgl2",{alpha:!1,antialias:!1,powerPreference:"high-performance"});this.renderer=new gE({canvas:e,context:t}),this.scene=new _E,this.camera=new ei(55,1,.1,2e3),this.camera.up.set(0,0,1),this.controls=new wE(this.camera,e),this.controls.enableDamping=!0,this.controls.maxPolarAngle=Math.PI*.98,this.controls.addEventListener("change",()=>this.dirty=!0),this.fresh=new KE,this.map=new GE,this.rings=cb(),this.ruler=new sb(this.fresh,this.camera,e),this.ellipse=new zE,this.scene.add(this.rings,this.ellipse.object,this.ruler.object);const n=new URLSearchParams(location.search).get("draw");n==="raster"||n!=="webgl"&&eb(this.renderer.getContext())?(this.raster=new tb,this.scene.add(this.raster.object,this.map.line)):this.scene.add(this.map.object,this.fresh.object),this.sensor=new H,this.follow=!0,this.frames=0,this.drawnAt=performance.now(),this.ground=-1.9,this.home(),new ResizeObserver(()=>this.resize()).observe(e.parentElement),this.resize()}home(){this.camera.position.copy(ob).add(this.sensor),this.controls.target.copy(id).add(this.sensor),this.controls.update(),this.dirty=!0}resize(){const{clientWidth:e,clientHeight:t}=this.canvas.parentElement;e===0||t===0||(this.renderer.setPixelRatio(Math.min(devicePixelRatio,2)),this.renderer.setSize(e,t,!1),this.camera.aspect=e/t,this.camera.fov=e<t?80:55,this.camera.updateProjectionMatrix(),this.raster?.resize(this.canvas.width,this.canvas.height),this.fresh.uniforms.scale.value=t*this.renderer.getPixelRatio()/13,this.dirty=!0)}setTheme(e,t,n){this.scene.background=new xt(e.ground);for(const s of this.rings.children)s.material.color.set(s.name==="sensor"?e.accent:e.line),s.material.opacity=.8;this.map.setColors(e.map,e.accent),this.ellipse.object.material.color.set(e.accent),this.ruler.setColor(e.text),this.setColors(t,n),this.dirty=!0}setColors(e,t){this.fresh.setColors(e,t),this.raster?.setColors(e,t,this.scene.background)}moveSensor(e){const t=new H().setFromMatrixPosition(e);if(this.follow){const n=t.clone().sub(this.sensor);this.camera.position.add(n),this.controls.target.add(n)}this.sensor.copy(t),this.rings.quaternion.setFromRotationMatrix(e),this.dirty=!0}showMap(e){this.map.object.visible=this.map.line.visible=e,this.dirty=!0}setFollow(e){if(e&&!this.follow){const t=this.sensor.clone().add(id).sub(this.controls.target);this.camera.position.add(t),this.controls.target.add(t)}this.follow=e,this.dirty=!0}add(e,t,n,s,r){this.fresh.add(e,t,n,s),n&&(this.moveSensor(n),r&&this.map.add(e,n)),this.dirty=!0}setCovariance(e){this.ellipse.object.visible=e!==null,e&&this.ellipse.set(e),this.dirty=!0}clear(){this.fresh.clear(),this.map.clear(),this.setCovariance(null),this.dirty=!0}nudge(e,t,n){const s=this.camera.position.clone().sub(this.controls.target),r=new Jc().setFromVector3(new H(s.x,s.z,-s.y));r.theta+=e*sd,r.phi=Kc.clamp(r.phi-t*sd,.02,Math.PI*.98),r.radius=Kc.clamp(r.radius*lb**n,1,800);const o=new H().setFromSpherical(r);this.camera.position.copy(this.controls.target).add(new H(o.x,-o.z,o.y)),this.controls.update(),this.dirty=!0}lookDown(){const{target:e}=this.controls,t=this.camera.position.distanceTo(e);this.camera.position.set(e.x-.001*t,e.y,e.z+t),this.controls.update(),this.dirty=!0}get pose(){const{position:e}=this.camera;return[e,this.controls.target].flatMap(t=>t.clone().sub(this.sensor).toArray())}set pose(e){this.camera.position.fromArray(e,0).add(this.sensor),this.controls.target.fromArray(e,3).add(this.sensor),this.controls.update(),this.dirty=!0}draw(){const e=performance.now();return this.controls.dampingFactor=1-Math.exp((this.drawnAt-e)/ab),this.drawnAt=e,this.controls.update(),this.dirty?(this.dirty=!1,this.rings.position.copy(this.sensor),this.rings.position.z+=this.ground,this.ellipse.object.position.copy(this.rings.position),this.fresh.update(),this.raster&&(this.camera.updateMatrixWorld(),this.raster.draw(this.fresh,this.map,this.camera)),this.renderer.render(this.scene,this.camera),this.fresh.drawn(),this.map.drawn(),++this.frames,!0):!1}picture(){return this.dirty=!0,this.draw(),new Promise(e=>this.canvas.toBlob(e,"image/png"))}}const ub=1,fb=1,rd=10,od={ArrowLeft:-1,ArrowDown:-1,ArrowRight:1,ArrowUp:1,PageDown:-60,PageUp:60};function db(i){if(i<60)return`${di(i,i<10?1:0)} s`;const e=Math.round(i),t=[Math.floor(e/3600),Math.floor(e/60)%60,e%60],n=t[0]>0;return`${(n?t:t.slice(1)).map((r,o)=>o>0?String(r).padStart(2,"0"):r).join(":")} ${n?"h":"min"}`}class pb{constructor(e,t){Object.assign(this,{element:e,on:t}),this.slider=e.querySelector("input"),this.output=e.querySelector("output"),this.words=e.querySelector("#recording"),this.at=null,this.asked=null,this.span=[0,0],this.slider.oninput=()=>this.seek(this.span[1]+Number(this.slider.value)),this.slider.onkeydown=n=>{n.ctrlKey||n.metaKey||n.altKey||!(n.key in od)||(n.preventDefault(),this.step(od[n.key]))},e.querySelector("#back").onclick=()=>this.step(-rd),e.querySelector("#forth").onclick=()=>this.step(rd),this.update()}get isPast(){return this.at!==null}seek(e){const[t,n]=this.span,s=this.isPast;this.at=this.asked=Math.min(Math.max(e,t),n),this.on.jump(this.at),s||this.on.past(),this.update()}step(e){(this.isPast||e<0)&&this.seek((this.at??this.span[1])+e)}live(){this.isPast&&(this.at=this.asked=null,this.on.live(),this.update())}forget(){this.live(),this.span=[0,0],this.update()}answered({time:e,next:t},n){return e!==this.asked?!1:(this.asked=null,!n&&t!==null&&t>this.at+fb&&(this.at=t),!0)}tick(e,t){if(!this.isPast||t)return;const n=Math.max(this.at+e,this.span[0]);if(n>=this.on.last())return this.live();this.at=Math.max(this.at,Math.min(n,this.on.reach())),this.asked===null&&(this.asked=this.at,this.on.ask(this.at))}tell(e){e!==this.words.textContent&&(this.words.textContent=e)}update(){const[e,t]=this.span;this.element.hidden=!this.isPast&&this.words.textContent===""&&t-e<ub;const n=this.isPast?Math.max(t-this.at,0):0;this.slider.min=(e-t).toFixed(1),this.slider.value=-n;const s=this.isPast?`${db(n)} ${Ht("ago")}`:Ht("live");this.output.textContent=this.isPast?s:"",this.slider.setAttribute("aria-valuetext",s)}}const mb=1,gb=400,_b="(max-width: 760px)",Yt=i=>document.getElementById(i),vb=i=>{try{return localStorage.getItem(i)}catch{return null}};function xb(i){if(i.length===0)return[0,1];i.sort();const e=t=>i[Math.floor(t*(i.length-1))];return[e(.02),e(.98)]}class Sb{constructor(e){this.page=e,this.mode="height",this.scales={height:[-2,6],intensity:[0,1],range:[0,50],beam:[0,127],age:[0,100]},this.known={intensity:!0,beam:!0},this.theme=vb("theme")??"system",this.learned=0,this.makeColors(),this.makeButtons(),this.makeClip(),this.makeRuler(),matchMedia("(prefers-color-scheme: dark)").addEventListener("change",()=>this.applyTheme()),this.setPanel(!matchMedia(_b).matches),this.applyTheme(),addEventListener("keydown",t=>this.onKey(t)),this.readAddress(),e.scene.controls.addEventListener("end",()=>this.share())}makeColors(){const e=Yt("colors");for(const t of Object.keys(go)){const n=document.createElement("button");n.textContent=Ht(t),n.dataset.mode=t,n.setAttribute("role","radio"),n.onclick=()=>{this.setMode(t),this.share()},e.append(n)}e.addEventListener("keydown",t=>{const n={ArrowRight:1,ArrowLeft:-1}[t.key];if(!n)return;t.preventDefault();const s=[...e.children].filter(o=>!o.disabled),r=s[(s.indexOf(document.activeElement)+n+s.length)%s.length];r.focus(),r.click()})}setMode(e){this.mode=e;for(const t of Yt("colors").children){const n=t.dataset.mode===e;t.setAttribute("aria-checked",n),t.tabIndex=n?0:-1,t.disabled=this.known[t.dataset.mode]===!1}this.page.scene.setColors(e,this.isDark),this.applyScale()}applyScale(){const[e,t]=this.scales[this.mode];this.page.scene.fresh.setScale(e,t),this.page.scene.dirty=!0;const{unit:n}=go[this.mode],s=Yt("legend");s.querySelector("figcaption").textContent=Ht(this.mode)+(n?` [${n}]`:"");const r=l=>di(l,Math.abs(l)<10&&l%1?1:0);[e,t].forEach((l,c)=>s.querySelectorAll("span")[c].textContent=r(l));const o=s.querySelector("canvas").getContext("2d"),a=Ch(Ah(this.mode,this.isDark));o.putImageData(new ImageData(new Uint8ClampedArray(a),256,1),0,0)}learn(e,t){(t.intensity!==this.known.intensity||t.beam!==this.known.beam)&&(this.known=t,this.setMode(this.known[this.mode]===!1?"height":this.mode));const n=performance.now();if(e.length===0||n-this.learned<1e3)return;this.learned=n;const s=e.length/gi,r=Math.max(1,Math.floor(s/2e3)),o={height:2,intensity:3,range:5};for(const[c,u]of Object.entries(o)){const h=[];for(let v=0;v<s;v+=r)h.push(e[v*gi+u]);const f=xb(new Float32Array(h)),m=this.scales[c],_=this.seen!==!0;this.scales[c]=m.map((v,p)=>_?f[p]:v+.2*(f[p]-v))}this.scales.range[0]=this.scales.intensity[0]=0;let a=this.seen?this.scales.beam[1]:1;for(let c=4;c<e.length;c+=gi*7)a=Math.max(a,e[c]);this.scales.beam[1]=a;const l=this.scales.height[0];this.page.hasPoses||(this.page.scene.ground=l),this.seen=!0,this.applyScale()}setSpan(){const e=Yt("trail").getAttribute("aria-pressed")==="true",t=e?mb:this.page.spanS*.995;this.page.scene.fresh.setSpan(t,e),this.scales.age[1]=Math.round(t*1e3),this.mode==="age"&&this.applyScale(),this.page.scene.dirty=!0}hasPoses(e){this.page.hasPoses!==e&&(this.page.hasPoses=e,Yt("map").disabled=Yt("follow").disabled=!e)}toggle(e,t){return Yt(e).setAttribute("aria-pressed",t),t}isOn(e){return Yt(e).getAttribute("aria-pressed")==="true"}makeButtons(){const{page:e}=this;Yt("map").disabled=Yt("follow").disabled=!0;const t={follow:()=>e.scene.setFollow(this.toggle("follow",!this.isOn("follow"))),map:()=>e.scene.showMap(this.toggle("map",!this.isOn("map"))),trail:()=>{this.toggle("trail",!this.isOn("trail")),this.setSpan()},measure:()=>e.scene.ruler.turn(this.toggle("measure",!this.isOn("measure"))),top:()=>e.scene.lookDown(),pause:()=>{e.paused=this.toggle("pause",!this.isOn("pause")),e.choose(),e.showState()},snapshot:()=>this.snapshot(),panel:()=>this.setPanel(!this.isOn("panel")),live:()=>{e.paused&&Yt("pause").click(),e.timeline.live()},more:()=>this.setSheet(document.body.dataset.sheet==="closed"),theme:()=>this.nextTheme()};for(const[n,s]of Object.entries(t))Yt(n).onclick=()=>{s(),this.share()}}makeRuler(){const e=Yt("distance");this.page.scene.ruler.onChange=({points:t,distance:n,rise:s})=>{this.page.scene.dirty=!0,e.hidden=!this.isOn("measure"),n!==null?e.textContent=`${di(n,2)} m  (Δz ${di(s,2)} m)`:e.textContent=Ht(t.length?"measure_second":"measure_first")}}makeClip(){const e=[Yt("clip_low"),Yt("clip_high")];this.clip=e;for(const t of e)t.oninput=()=>this.applyClip(),t.onchange=()=>this.share();this.applyClip()}applyClip(){const[e,t]=this.clip.map(s=>Number(s.value)),n=[e<=Number(this.clip[0].min),t>=Number(this.clip[1].max)];this.page.scene.fresh.setClip(n[0]?-Ca:e,n[1]?Ca:t),this.page.scene.dirty=!0,[e,t].forEach((s,r)=>{this.clip[r].parentElement.querySelector("output").textContent=n[r]?"–":di(s,1)})}setRobots(e){const t=Yt("robot");t.hidden=e.length<2,`${e}`!=`${this.robots}`&&(this.robots=e,t.replaceChildren(...e.map(n=>new Option(n,n))),e.includes(this.page.robot)&&(t.value=this.page.robot),t.onchange=()=>{this.page.robot=t.value,this.page.forget(),this.page.choose(),this.share()})}share(){clearTimeout(this.sharing),this.sharing=setTimeout(()=>{const[e,t]=this.clip,n={color:this.mode==="height"?null:this.mode,robot:this.page.robot||null,trail:this.isOn("trail")?1:null,from:e.value===e.min?null:e.value,to:t.value===t.max?null:t.value,camera:this.page.scene.pose.map(o=>o.toFixed(1)).join()},s=Object.entries(n).filter(([,o])=>o!==null),r=new URL(location.href);r.hash=new URLSearchParams(s),history.replaceState(null,"",r)},gb)}readAddress(){const e=new URLSearchParams(location.hash.slice(1));e.get("color")in go&&this.setMode(e.get("color")),this.page.robot=e.get("robot")??"",e.get("trail")&&this.toggle("trail",!0),e.get("from")&&(this.clip[0].value=e.get("from")),e.get("to")&&(this.clip[1].value=e.get("to")),this.applyClip();const t=(e.get("camera")??"").split(",").map(Number);t.length===6&&t.every(Number.isFinite)&&(this.page.scene.pose=t)}setSheet(e){Yt("more").setAttribute("aria-expanded",e),document.body.dataset.sheet=e?"open":"closed"}setPanel(e){this.toggle("panel",e),document.body.dataset.panel=e?"open":"closed"}async snapshot(){const e=await this.page.scene.picture(),t=document.createElement("a");t.href=URL.createObjectURL(e),t.download=`gst-lidar-${new Date().toISOString().replace(/[:.]/g,"-")}.png`,t.click(),setTimeout(()=>URL.revokeObjectURL(t.href),1e3)}onKey(e){const t=e.target.type==="range";if(e.ctrlKey||e.metaKey||e.altKey||!t&&["INPUT","SELECT"].includes(e.target.tagName))return;const n=e.target===Yt("scene")||e.target===document.body,{scene:s}=this.page,r={ArrowLeft:[-1,0,0],ArrowRight:[1,0,0],ArrowUp:[0,1,0],ArrowDown:[0,-1,0],"+":[0,0,1],"=":[0,0,1],"-":[0,0,-1]};if(n&&r[e.key])return e.preventDefault(),s.nudge(...r[e.key]);if(n&&e.key==="0")return s.home();const o={f:"follow",m:"map",t:"trail",s:"snapshot",c:"panel",d:"theme",r:"measure",o:"top",l:"live",b:"back",n:"forth"},a=(n||t)&&e.key===" "?"pause":o[e.key.toLowerCase()];!a||Yt(a).disabled||(e.preventDefault(),Yt(a).click())}get isDark(){return this.theme!=="system"?this.theme==="dark":matchMedia("(prefers-color-scheme: dark)").matches}nextTheme(){this.theme=this.isDark?"light":"dark";try{localStorage.setItem("theme",this.theme)}catch{}this.applyTheme()}applyTheme(){document.documentElement.dataset.theme=this.isDark?"dark":"light";const e=getComputedStyle(document.documentElement),t=n=>e.getPropertyValue(`--${n}`).trim();this.colors={muted:t("muted"),line:t("line"),series:["accent","second","third","fourth"].map(t)},this.page.scene.setTheme({ground:t("ground"),text:t("text"),line:t("line"),accent:t("accent"),map:t("map")},this.mode,this.isDark),this.setMode(this.mode)}style(){return this.colors}}const Mb=i=>new Sb(i),ad={h264:"avc1.42E01F",vp8:"vp8"},ld=8,yb=4,cd=1,Eb=32<<20;function bb(i,e){if(i==="vp8")return(e[0]&1)===0;for(let t=0;t+3<e.length;++t)if(e[t]===0&&e[t+1]===0&&e[t+2]===1&&(e[t+3]&31)===5)return!0;return!1}class Tb{constructor(e){this.canvas=e,this.context=e.getContext("2d"),this.held=[],this.clear()}clear(){this.kept=[],this.bytes=0,this.first=0,this.live()}live(){this.next=null,this.at=null,this.reset()}reset(){this.canvas.hidden=!0,this.held.splice(0).forEach(e=>e.close()),this.format=null,this.decoder?.state==="configured"&&this.decoder.close()}start(e){this.format=e,this.needsKey=!0,this.decoder=new VideoDecoder({output:t=>this.held.push(t),error:()=>this.format=null}),this.decoder.configure({codec:ad[e],optimizeForLatency:!0})}add({time:e,format:t,data:n}){if(!(t in ad)||typeof VideoDecoder!="function")return;const s={time:e,format:t,data:n,key:bb(t,n)};this.keep(s),this.at===null&&this.decode(s)}keep(e){for(this.kept.push(e),this.bytes+=e.data.length;this.bytes>Eb;++this.first)this.bytes-=this.kept.shift().data.length}decode({time:e,format:t,data:n,key:s}){if(t!==this.format){if(!s)return;this.start(t)}if(this.decoder.decodeQueueSize>ld&&(this.needsKey=!0),this.needsKey&&!s)return;this.needsKey=!1;const r=Math.round(e*1e6);this.decoder.decode(new EncodedVideoChunk({type:s?"key":"delta",timestamp:r,data:n}))}replay(e){const t=this.next===null||e<this.at||e>this.at+cd||this.next<this.first;if(this.at=e,t&&this.jump(e),this.next!==null){for(let n;(n=this.kept[this.next-this.first])?.time<=e&&!(this.decoder?.decodeQueueSize>=ld);++this.next)this.decode(n);this.draw(e)}}jump(e){this.reset();const t=this.kept.findLastIndex(n=>n.key&&n.time<=e);this.next=t<0?null:this.first+t}draw(e){const t=o=>o.timestamp*1e-6-e,n=o=>e===null||t(o)<=0||t(o)>cd;let s=this.held.findLastIndex(n);if(s=Math.max(s,this.held.length-1-yb),s<0)return;const r=this.held.splice(0,s+1);this.show(r[s]),r.forEach(o=>o.close())}show(e){const{canvas:t}=this;t.hidden=!1,t.width!==e.displayWidth&&(t.width=e.displayWidth),t.height!==e.displayHeight&&(t.height=e.displayHeight),this.context.drawImage(e,0,0),this.shown=e.timestamp*1e-6}}class wb{constructor(e){this.bytes=e,this.view=new DataView(e.buffer,e.byteOffset,e.byteLength),this.at=0}varint(){let e=0,t=1;for(;;){const n=this.bytes[this.at++];if(e+=(n&127)*t,!(n&128))return e;t*=128}}fields(e){for(;this.at<this.bytes.length;){const t=this.varint(),n=t>>>3;switch(t&7){case 0:e(n,this.varint());break;case 1:e(n,this.view.getFloat64(this.at,!0)),this.at+=8;break;case 2:{const s=this.varint();e(n,this.bytes.subarray(this.at,this.at+s)),this.at+=s;break}case 5:e(n,this.view.getUint32(this.at,!0)),this.at+=4;break;default:throw new Error("unknown wire type")}}}}const Mo=new TextDecoder;function zs(i,e){const t={};return new wb(i).fields((n,s)=>{var o;const r=e[n];r!==void 0&&(r.endsWith("[]")?(t[o=r.slice(0,-2)]??(t[o]=[])).push(s):t[r]=s)}),t}function Wa(i){const e=i?zs(i,{1:"s",2:"ns"}):{};return(e.s??0)+(e.ns??0)*1e-9}const hd=(i,e)=>{const t=i?zs(i,{1:"0",2:"1",3:"2",4:"3"}):{};return Array.from({length:e},(n,s)=>t[s]??(s===3&&!i?1:0))};function Ab(i){const e=zs(i,{1:"time",2:"frame",4:"stride",5:"fields[]",6:"data"});return{time:Wa(e.time),frame:e.frame?Mo.decode(e.frame):"",stride:e.stride??0,fields:(e.fields??[]).map(t=>{const n=zs(t,{1:"name",2:"offset",3:"type"});return{name:Mo.decode(n.name),offset:n.offset??0,type:n.type??0}}),data:e.data??new Uint8Array}}function Cb(i){const e=zs(i,{1:"time",2:"frame",4:"data"});return{time:Wa(e.time),frame:e.frame?Mo.decode(e.frame):"",data:e.data??new Uint8Array}}function Rb(i){const e=zs(i,{1:"time",3:"data",4:"format"});return{time:Wa(e.time),format:e.format?Mo.decode(e.format):"",data:e.data??new Uint8Array}}function Gp(i){const e=zs(i,{1:"time",2:"parent",3:"child",4:"translation",5:"rotation"});return{time:Wa(e.time),child:e.child?Mo.decode(e.child):"",position:hd(e.translation,3),rotation:hd(e.rotation,4)}}const Pb=2e3,Db=250,Lb=100,Ub=60;__(document);const $={state:"connecting",paused:!1,quietMs:0,clouds:0,points:0,bytes:0,age:null,received:{},spanS:.1,kept:null,isLoading:!1,robot:"",charts:new y_(document.getElementById("charts")),scene:new hb(document.getElementById("scene")),poses:new Qc,recordedPoses:new Qc,links:new p_,video:new Tb(document.getElementById("video"))},yo=Mb($);$.slices=new U_({points:Nb,picture:Fb,span:i=>{$.kept=i,Yp()},arrived:(i,e)=>$.replay.arrived(i,e),pose:({replay:i},e)=>{i===$.replay.number&&$.recordedPoses.add(Gp(e))}},()=>$.connection);$.replay=new bE({begin:i=>{$.recordedPoses=new Qc,$.slices.replay(i)},end:()=>$.slices.replay(0),show:i=>$.slices.show(i,!0),known:Yp},()=>$.connection);$.timeline=new pb(document.getElementById("timeline"),{jump:Ob,ask:i=>$.replay.isOn?$.replay.show(i):$.slices.show(i),reach:()=>$.replay.isOn?$.replay.reach:1/0,last:()=>$.replay.isOn?$.replay.last:$.timeline.span[1],past:ud,live:()=>{$.slices.show(null),$.video.live(),$.replay.end(),$.choose(),ud()}});let ha=null;const so=new Map;function Ib(i){ha||(ha=new Worker(new URL("draco_worker.js",document.baseURI)),ha.onmessage=({data:{id:t,positions:n,intensities:s}})=>{const r=so.get(t);so.delete(t),r&&n&&Rh(r,J_(n,s))}),so.size>64&&so.clear(),$.dracoId=($.dracoId??0)+1,so.set($.dracoId,{time:i.time,frame:i.frame});const e=i.data.slice().buffer;ha.postMessage({id:$.dracoId,data:e},[e])}function Rh(i,e){if($.quietMs=0,++$.clouds,$.points+=e.points.length/6,$.paused||$.timeline.isPast)return;Wp(i,e);const{time:t,ageOf:n}=i;$.newest={time:t,ageOf:n??(s=>fo()-s)}}function Wp({time:i,frame:e,place:t},{points:n,has:s}){yo.learn(n,s);const r=($.replay.isOn?$.recordedPoses:$.poses).at(e,i);yo.hasPoses(r!==null),$.scene.add(n,i,r,t,!$.timeline.isPast)}const Xp=(i,e)=>({time:e.captured,frame:i.frameId,place:e});function Nb(i,e,t,n){const[s,r]=i.framerate??[0,1];s>0&&!$.paused&&($.spanS=r/s),$.quality={step:t.step,error_bound:t.error},Rh({...Xp(i,e),ageOf:o=>n.ageOf(o)},t)}function Fb(i){if($.timeline.answered(i,$.paused)){if(i.jumped&&$.scene.fresh.clear(),$.replay.isOn)for(const{points:e}of i.slices)$.points+=e.length/6;for(const{stream:e,header:t,...n}of i.slices)Wp(Xp($.slices.abouts[e],t),n);$.scene.dirty=!0}}function Yp(){const{replay:i,timeline:e}=$,t=i.span??(i.isOn?null:$.kept);t&&(e.span=t),i.isOn&&i.isBroken&&e.live();const n=i.isBroken?"recording_broken":i.isDamaged?"recording_damaged":"";e.tell(n&&Ht(n))}function Ob(i){if($.replay.span===null)return $.slices.show(i);const e=$.replay.isOn;$.replay.begin(i),e||$.choose()}function ud(){const{isPast:i}=$.timeline;i?$.scene.setCovariance(null):$.scene.fresh.clear(),$.age=null,document.body.dataset.time=i?"past":"live",Gr($.state)}$.forget=()=>{$.kept=null,$.slices.forget(),$.timeline.forget(),$.replay.forget(),$.scene.clear(),$.video.clear()};function qp(i){$.statistics=i;const e=Object.values(i.elements??{}).find(n=>n.factory==="foxglovesink");e?.scan_duration>0&&!$.paused&&($.spanS=e.scan_duration*1e-9),yo.setSpan(),i.pose_covariance&&!$.timeline.isPast&&$.scene.setCovariance(i.pose_covariance);const t=$.links.of(i,fo());$.charts.add({...$.quality,...i,...t,received:$.receivedBps,age:$.age})}const fd={"foxglove.PointCloud":i=>{const e=Ab(i);Rh(e,$_(e))},"foxglove.CompressedPointCloud":i=>Ib(Cb(i)),"foxglove.CompressedVideo":i=>$.video.add(Rb(i)),"foxglove.FrameTransform":i=>$.poses.add(Gp(i)),"lidar.Slice":(i,e,t)=>$.slices.add(e,i,t),"lidar.Statistics":i=>qp(JSON.parse(new TextDecoder().decode(i)))},Bb=["stalled","lost","refused","expired","foreign","limited","full"];function Gr(i){$.state=i,document.body.dataset.state=i,document.body.toggleAttribute("data-paused",$.paused);const e=Ht($.timeline.isPast?$.isLoading?"loading":"past":i);document.querySelector("#state span").textContent=$.paused?`${e}, ${Ht("paused")}`:e;const t=document.getElementById("notice");t.hidden=!Bb.includes(i),t.textContent=t.hidden?"":Ht(`${i}_text`)}$.showState=()=>Gr($.state);function kb(){if($.state!=="live"&&$.state!=="stalled")return;($.paused||$.replay.isOn)&&($.quietMs=0);const i=$.quietMs>Pb;i!==($.state==="stalled")&&Gr(i?"stalled":"live")}function zb(){const{replay:i,timeline:e}=$,t=i.isOn&&(i.wanted!==null||e.at>=i.reach);t!==$.isLoading&&($.isLoading=t,Gr($.state))}let dd=performance.now();function Vb(){const i=performance.now(),e=(i-dd)/1e3;dd=i,$.receivedBps=$.bytes*8/e;const t=Math.round($.points/e),n=$.state==="live",s=$.age===null?[]:[`${di($.age*1e3)} ms ${Ht("old")}`];$.timeline.isPast&&s.push(new Date($.timeline.at*1e3).toLocaleTimeString(ka));const r=[`${di($.receivedBps*1e-6,1)} Mbit/s ${Ht("to_page")}`,`${di(t)} pt/s`];document.getElementById("facts").textContent=n?s.concat(r).join(" · "):"",$.bytes=$.points=$.clouds=0}function Hb(){const i=new URL(location.href),e=i.searchParams.get("token");return e===null?sessionStorage.getItem("token")??"":(sessionStorage.setItem("token",e),i.searchParams.delete("token"),history.replaceState(null,"",i),e)}function Gb(i){const e=document.getElementById("entry"),t=document.getElementById("wrong"),n=document.getElementById("token");t.hidden=!sessionStorage.getItem("token"),t.textContent=Ht(`${i}_text`),n.setAttribute("aria-invalid",!t.hidden),e.open||e.showModal(),n.select(),e.onclose=()=>{sessionStorage.setItem("token",n.value),jp()}}function jp(){const i={state:t=>{t==="open"&&($.quietMs=0),t==="lost"&&$.poses.end(),!(t==="connecting"&&$.state!=="connecting")&&(Gr(t==="open"?"live":t),(t==="refused"||t==="expired")&&Gb(t))},channels:t=>yo.setRobots(np(t)),message:(t,n,s)=>{var o,a;$.bytes+=n.length;const r=(o=$.received)[a=t.schemaName]??(o[a]={messages:0,bytes:0});++r.messages,r.bytes+=n.length,fd[t.schemaName](n,t,s)},subscribed:t=>$.replay.subscribed(t),dropped:t=>{$.slices.close(t),$.replay.dropped(t)},recording:(t,n)=>$.replay.status(t,n)},e=t=>N_(t,{known:fd,robot:$.robot,idle:document.hidden,paused:$.paused&&!$.replay.isOn});$.connection=new ap(location.host,Hb(),i,e)}$.choose=()=>$.connection?.choose();document.addEventListener("visibilitychange",()=>{$.quietMs=0,$.choose()});function Wb(){for(const i of new URL(location.href).searchParams.getAll("also")){const e={state:()=>{},message:(t,n)=>qp(JSON.parse(new TextDecoder().decode(n)))};new ap(i,"",e,t=>t.filter(n=>n.schemaName==="lidar.Statistics"))}}function Xb(){if($.slices.drawn(),$.replay.acknowledge(),!$.newest)return;const i=$.newest.ageOf($.newest.time);$.age=i>=0&&i<Ub?i:null,$.newest=null}let ql=0,pd=0;function Kp(i){$.timeline.tick((i-ql)/1e3,$.paused||$.replay.wanted!==null),$.scene.draw();const{time:e}=$.scene.fresh;$.timeline.isPast?e!==null&&$.video.replay(e):$.video.draw(e),Xb(),$.quietMs+=Math.min(i-ql,Lb),ql=i,i-pd>Db&&(pd=i,$.charts.draw(yo.style()),$.timeline.update(),kb(),zb()),requestAnimationFrame(Kp)}Gr("connecting");jp();Wb();setInterval(Vb,1e3);requestAnimationFrame(Kp);window.lidarPage=$;
